"""What some tests need of the machine."""

import os

import pytest

posix_only = pytest.mark.skipif(os.name != "posix", reason="needs process groups, limits or a shell of POSIX")
