#!/usr/bin/env bash
# Does it work on a machine that holds nothing yet?
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/bare_system.sh [-h] [--user] [--packages BUILD | COMMAND...]

Makes a bare Debian 12 in a temporary folder (debootstrap's smallest system, git, sudo and Python), clones the last commit of this
checkout into it, and runs COMMAND there; by default `bash apps/demo.sh`. Needs root, debootstrap, a network and 4 GB under
TMPDIR. What it made is removed. Exit status: that of the command; 77: not root, or no debootstrap.

  --user            as a user who may become root with sudo, not as root
  --packages BUILD  installs the Debian packages of the build folder BUILD there instead, uses and removes them, see
                    test/packages/check_packages.sh

examples: bash test/bare_system.sh --user bash test/run.sh
          bash test/bare_system.sh --packages build
END
}

skip() {
  echo "skipped: $*"
  exit 77
}

fail() {
  echo "bare_system.sh: $*" >&2
  exit 1
}

as_user=false packages=
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --user) as_user=true ;;
    --packages)
      packages=$(realpath "${2:?bare_system.sh: --packages needs a build folder}")
      shift ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done
((EUID == 0)) || skip "needs root"
command -v debootstrap >/dev/null || skip "needs debootstrap (apt-get install debootstrap)"
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")

root=$(mktemp -d)
chmod 755 "$root"  # it is / to those who work in it
# Nothing is ever mounted in it where this shell looks: see in_namespace.
trap 'rm -rf --one-file-system "$root"' EXIT

# Runs a command where /proc, /dev and /sys of the bare system are mounted; they are gone when it ends.
in_namespace() {
  unshare --mount --propagation private bash -euc '
    root=$1
    shift
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --rbind /sys "$root/sys"
    exec "$@"' bash "$root" "$@"
}

echo "== A bare system in $root"
unshare --mount --propagation private debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 ||
  fail "debootstrap failed: $(tail -3 "$root.log")"
rm -f "$root.log"
cp /etc/resolv.conf "$root/etc/resolv.conf"

if [[ -n $packages ]]; then
  in_namespace bash "$source/test/packages/check_packages.sh" "$packages" "$root"
  exit
fi

in_namespace chroot "$root" bash -euc 'apt-get -q update && DEBIAN_FRONTEND=noninteractive apt-get -q -y install git sudo python3' >/dev/null
user=root home=/root
if $as_user; then
  user=tester home=/home/tester
  chroot "$root" useradd --create-home --shell /bin/bash "$user"
  echo "$user ALL=(ALL) NOPASSWD: ALL" >"$root/etc/sudoers.d/$user"
fi
git clone -q "$source" "$root$home/pcl_symmetry"
chroot "$root" chown -R "$user:" "$home/pcl_symmetry"
(($# > 0)) || set -- bash apps/demo.sh
echo "== As $user: $*"
in_namespace chroot "$root" su - "$user" -c "cd pcl_symmetry && $(printf '%q ' "$@")"
