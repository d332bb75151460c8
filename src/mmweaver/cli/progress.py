"""A progress bar, shown only on a terminal and only for stages of more than two seconds.

The log on stderr: silent by default but for warnings, each stage with its seconds with --verbose.
"""

import sys
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tqdm import tqdm


def set_up_log(*, verbose: bool) -> None:
    """Sends warnings of mmweaver to stderr; with `verbose` each stage, too."""
    import logging

    logger = logging.getLogger("mmweaver")
    for handler in [one for one in logger.handlers if one.get_name() == "mmweaver"]:
        logger.removeHandler(handler)
    handler = logging.StreamHandler(sys.stderr)
    handler.set_name("mmweaver")
    handler.setFormatter(logging.Formatter("%(levelname)-7s %(name)s: %(message)s"))
    logger.addHandler(handler)
    logger.setLevel("INFO" if verbose else "WARNING")


PATIENCE_S = 2.0


class StageBar:
    """Shows the current stage; silent if stderr is not a terminal, or `quiet` is set."""

    def __init__(self, num_stages: int, *, quiet: bool = False, patience_s: float = PATIENCE_S):
        self._patience_s = patience_s
        self._num_stages, self._silent = num_stages, quiet or not sys.stderr.isatty()
        self._bar: tqdm | None = None

    def __call__(self, stage: str) -> None:
        """Hears that a stage begins."""
        if self._silent:
            return
        if self._bar is None:
            from tqdm import tqdm

            shape = "{desc:<28} {bar:24} {n_fmt}/{total_fmt} {elapsed}"
            self._bar = tqdm(
                total=self._num_stages, file=sys.stderr, leave=False, delay=self._patience_s, bar_format=shape
            )
            self._bar.set_description_str(stage, refresh=False)
        else:
            self._bar.set_description_str(stage, refresh=False)
            self._bar.update()

    def progress(self, stage: str, done: int, total: int) -> None:
        """Updates the progress of a stage.

        Args:
            stage: Name of the stage.
            done: Amount done.
            total: Total amount.
        """
        if self._bar is None or self._bar.desc != stage:
            self(stage)
        if self._bar is not None:
            self._bar.total = total
            self._bar.update(done - self._bar.n)

    def __enter__(self) -> "StageBar":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._bar is not None:
            self._bar.close()
