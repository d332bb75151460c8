"""The study of compose times on a room without a photo."""

import numpy as np

from mmweaver.motion.empty_floor import empty_floor
from studies.motion import compose_times


def test_a_row_holds_the_times_of_all_sentences_but_the_first(monkeypatch):
    monkeypatch.setattr(compose_times, "SENTENCES", ("a person claps", "she squats", "he waves"))
    row = compose_times.room_row("empty", [empty_floor()])
    metrics = {name: metric["value"] for name, metric in row["metrics"].items()}
    assert row["n"] == 3 * compose_times.SEEDS
    assert row["refused"] == 0
    assert 0 < metrics["mean_s"] <= metrics["worst_s"]
    assert np.isfinite(metrics["first_s"])
