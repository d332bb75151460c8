"""Checks of extensions: the documented import path of `mmweaver.weaver.testing`."""

from mmweaver.weaver.testing import *  # noqa: F403
