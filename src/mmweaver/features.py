"""Features of a radar cube: the documented import path of `mmweaver.dsp.features`."""

from mmweaver.dsp.features import *  # noqa: F403
