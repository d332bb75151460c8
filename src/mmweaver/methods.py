"""Methods that make signals: the documented import path of `mmweaver.models.methods`."""

from mmweaver.models.methods import *  # noqa: F403
