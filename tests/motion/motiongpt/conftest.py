"""Tests of MotionGPT need its extra."""

import pytest

pytest.importorskip("transformers")
