"""python -m pcl_symmetry --version"""

import sys

import pcl_symmetry

if sys.argv[1:] == ["--version"]:
    print(pcl_symmetry.__version__)
else:
    print("usage: python -m pcl_symmetry --version", file=sys.stderr)
    sys.exit(2)
