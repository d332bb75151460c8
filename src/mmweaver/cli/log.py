"""The log on stderr: silent by default but for warnings, each stage with its seconds with --verbose."""

import sys


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
