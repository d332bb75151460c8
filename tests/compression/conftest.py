import pytest

from mmweaver.compression.optimiser import Optimiser


@pytest.fixture
def stored_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces are written without loss, whatever is asked for: tests of files need no search for a step."""
    for name in ("within_bytes", "within_error"):
        monkeypatch.setattr(Optimiser, name, lambda self, *_: self._exact())
