"""The documented import path of `mmweaver.weaver.register`."""

from mmweaver.weaver.register import *  # noqa: F403
