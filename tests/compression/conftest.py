import pytest

from mmweaver.compression import mmw_writer


@pytest.fixture
def stored_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces are written without loss, whatever is asked for: tests of files need no search for a step."""
    monkeypatch.setattr(mmw_writer, "encoded_chunks", lambda segment, **_: segment.exact())
