"""How far a long call is: a function of the caller, or a bar."""

from __future__ import annotations

import contextlib
import sys
from typing import Any, Callable, Iterator, Optional, Union

Progress = Union[bool, Callable[[float], Any], None]
"""True: a bar, of tqdm where it is installed. A function: called some times a second with the share of the running step that is
done, in [0, 1]; what it raises ends the call."""


class _Bar:
    """One bar for each step: where the share falls, the next one has begun."""

    def __init__(self) -> None:
        self._share, self._shown = 0.0, False
        self._bar: Any = None
        try:
            from tqdm.auto import tqdm

            self._bar = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}", leave=False)
        except ImportError:
            self._shown = sys.stderr.isatty()

    def tell(self, share: float) -> None:
        if self._bar is not None:
            if share < self._share:
                self._bar.reset()
                self._share = 0.0
            self._bar.update(share - self._share)
        elif self._shown:
            sys.stderr.write(f"\r[{'=' * round(40 * share):40}] {100 * share:3.0f} %")
            sys.stderr.flush()
        self._share = share

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._shown and self._share:
            sys.stderr.write("\r" + 50 * " " + "\r")


@contextlib.contextmanager
def shares_of(progress: Progress) -> Iterator[Optional[Callable[[float], Any]]]:
    """A function that takes shares for whoever asked for progress; None where nobody did."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        bar = _Bar()
        try:
            yield bar.tell
        finally:
            bar.close()
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress = {type(progress).__name__}, must be True, a function or None")


@contextlib.contextmanager
def telling(module: Any, progress: Progress) -> Iterator[None]:
    """Within it, calls of a module of the core tell their progress."""
    with shares_of(progress) as tell:
        if tell is None:
            yield
            return
        module.tell(tell)
        try:
            yield
        finally:
            module.tell(None)
