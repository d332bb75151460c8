"""A progress bar for people: only on a terminal, only for what takes over two seconds."""

import shutil
import sys
import threading
import time
from types import TracebackType

PATIENCE_S = 2.0
REFRESH_S = 0.25


class StageBar:
    """Shows which stage is running and for how long; silent where stderr is no terminal or `quiet` is set."""

    def __init__(self, num_stages: int, *, quiet: bool = False):
        self._num_stages = num_stages
        self._silent = quiet or not sys.stderr.isatty()
        self._stage, self._done = "", -1
        self._over = threading.Event()
        self._thread: threading.Thread | None = None

    def __call__(self, stage: str) -> None:
        """Hears that a stage begins."""
        self._stage = stage
        self._done += 1

    def __enter__(self) -> "StageBar":
        if not self._silent:
            self._thread = threading.Thread(target=self._show, daemon=True)
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        if self._thread is not None:
            self._thread.join()

    def _show(self) -> None:
        start = time.monotonic()
        if self._over.wait(PATIENCE_S):
            return
        from tqdm import tqdm

        size = shutil.get_terminal_size()  # tqdm shows nothing on a terminal that does not know its size
        with tqdm(
            desc=self._stage,
            initial=max(self._done, 0),
            total=self._num_stages,
            file=sys.stderr,
            leave=False,
            ncols=size.columns,
            nrows=size.lines,
            bar_format="{desc:<28} {bar:24} {n_fmt}/{total_fmt}{postfix}",
        ) as bar:
            while not self._over.wait(REFRESH_S):
                bar.n = max(self._done, 0)
                bar.set_description_str(self._stage, refresh=False)
                bar.set_postfix_str(f"{time.monotonic() - start:.0f} s", refresh=False)
                bar.refresh()
