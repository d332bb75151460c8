"""From sentences to a recogniser that works on unseen generated windows: the whole recipe on a small scale."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FIRMWARE
from mmweaver.core.presets import IWR1443_RADHAR
from mmweaver.recognition.activity_classifier import ClassifierSettings
from mmweaver.recognition.generated_windows import GenerationRecipe, generate_windows
from mmweaver.recognition.scoring import evaluate_recogniser, report
from mmweaver.recognition.variation import Variation
from mmweaver.recognition.zero_shot import read_training_set, training_set, write_training_set

RECIPE = GenerationRecipe(
    activities={"squats": ("a person squats quickly",), "walk": ("a person walks back and forth",)},
    radar=replace(IWR1443_RADHAR, num_samples=120, num_range_bins=64, frame_period_s=0.1),
    firmware=replace(FIRMWARE["iwr1443_radhar"], last_range_bin=100),
    variation=Variation(noise_db=(-3.0, 3.0), wall_share=0.0, most_panels=1, skin_exponents=(20.0,)),
)
SMALL = ClassifierSettings(num_trees=60, boosting_rounds=20)


@pytest.fixture(scope="module")
def made():
    return training_set(RECIPE, each=1, seed=1)


@pytest.mark.slow  # test_activity_classifier.py recognises unseen rows, test_evaluate.py trains on stored features
def test_unseen_windows_are_recognised():
    made = training_set(RECIPE, each=12, seed=1)
    unseen = generate_windows(RECIPE, each=6, seed=2)
    found = report(evaluate_recogniser(made.train(SMALL), unseen, RECIPE.window_s))
    assert found["window"]["balanced_accuracy"] > 0.74
    assert found["classes"] == ["squats", "walk"]


def test_a_training_set_round_trips_bit_by_bit(made, tmp_path):
    write_training_set(tmp_path / "a.npz", made)
    write_training_set(tmp_path / "b.npz", made)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    again = read_training_set(tmp_path / "a.npz")
    assert np.array_equal(again.features, made.features, equal_nan=True)
    assert again.names == made.names
    with pytest.raises(InputError, match=r"no plain \.npz archive"):
        (tmp_path / "c.npz").write_bytes(b"PK")
        read_training_set(tmp_path / "c.npz")


def test_a_cache_belongs_to_one_recipe(tmp_path):
    training_set(replace(RECIPE, window_s=0.3), each=1, cache=tmp_path)
    with pytest.raises(InputError, match="another recipe"):
        training_set(replace(RECIPE, window_s=0.4), each=1, cache=tmp_path)
