import pytest

from mmweaver.compression.mmw_codec import scale_of
from mmweaver.compression.rate_search import within_bytes
from mmweaver.compression.segment import SegmentEncoder
from mmweaver.core.errors import InputError
from tests.fields.echoes import crowd


def segment_of(cube) -> SegmentEncoder:
    segment = SegmentEncoder(cube, scale_of(cube))
    segment.plan_for(3000)
    return segment


def test_few_trials_suffice():
    """An estimate calibrated by the last trial finds the size; bisection alone would take a dozen trials."""
    trials: list[str] = []
    chunks = within_bytes(segment_of(crowd()), 3000, trials.append)
    assert 0.97 * 3000 <= sum(map(len, chunks)) <= 3000
    assert len(trials) <= 8


def test_what_cannot_be_reached_is_refused():
    with pytest.raises(InputError, match="too few"):
        within_bytes(segment_of(crowd(num_frames=1)), 5, lambda _: None)
    with pytest.raises(InputError, match="so many frames"):
        within_bytes(segment_of(crowd(num_frames=1)), -5, lambda _: None)
