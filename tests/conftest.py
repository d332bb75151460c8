"""Shared by all tests: where real recordings lie, if they are here at all."""

from pathlib import Path

import pytest

REAL_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real recordings; the test is skipped where it is absent."""
    if not REAL_DATA.is_dir():
        pytest.skip(f"no real recordings here: {REAL_DATA} is absent")
    return REAL_DATA
