"""The ablation on a tiny data set: variants train, ghosts count where they show, photos are those of the variant."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.models.power_field import NUM_WRITTEN
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.training.network_training import TrainingRecipe
from studies.network.ablated_network import PARTS
from studies.network.ablation import (
    COLUMNS,
    MEAN_COLUMNS,
    AblationMaterial,
    OtherMotion,
    mean_scores,
    network_of,
    photo_of,
    row_of,
    scores,
    slug,
    trained,
    with_one_code,
)
from studies.network.ablation_variants import VARIANTS, WHOLE, AblationVariant

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("blank_training_pictures")
RECIPE = TrainingRecipe(steps=2, batch_size=1, frames=2, validate_every=2, validation_batches=1, warm_up_steps=1)


@pytest.fixture(scope="module")
def material(tiny_geometry: Path) -> AblationMaterial:
    return AblationMaterial.of(tiny_geometry, 1, 1)


@pytest.mark.slow  # a training; network_of and its parts are tested below
def test_a_variant_is_trained_and_goes_on_as_it_was(material: AblationMaterial, tmp_path: Path):
    variant = AblationVariant(terms_without=("_person",), without=("steps",))
    one, again = (trained(variant, material, tmp_path, RECIPE) for _ in range(2))
    assert all(torch.equal(a, b) for a, b in zip(one.state_dict().values(), again.state_dict().values(), strict=True))
    figures = scores(one, lambda case: case.room, material.cases[0])
    assert set(figures) == {*COLUMNS, *MEAN_COLUMNS}
    assert np.isfinite(list(figures.values())).all()
    row = row_of("fewer", [figures], ["dining_room_0"])
    assert row["metrics"]["ra_ssim"]["value"] == figures["ra_ssim"]


def test_targets_of_sampled_signals_differ(material: AblationMaterial):
    (mean,), (sampled,) = material.mean[0], material.sampled[0]
    frames = np.array([1, 2])
    expected, alone = mean.maps(0, frames)
    draw, none = sampled.maps(0, frames)
    assert alone is not None
    assert none is None
    ratio = torch.log10(draw.range_doppler / expected.range_doppler)
    assert 0.1 < float(ratio.std()) < 1.5  # speckle


def test_ghosts_show_in_the_person_alone(material: AblationMaterial, tmp_path: Path):
    with_ghosts, without = (
        trained(AblationVariant(without=part, recipe=(("steps", 0),)), material, tmp_path, RECIPE)
        for part in ((), ("ghosts",))
    )
    case = material.cases[0]
    own, other = (mean_scores(learner, case.room, case) for learner in (with_ghosts, without))
    assert abs(own["person_rd_db"] - other["person_rd_db"]) > 0.005  # the person of the tiny data is far from walls


def test_each_variant_has_its_photo_and_names_known_parts(material: AblationMaterial):
    case = material.cases[0]
    photos = {
        photo: photo_of(case, AblationVariant(photo=photo), material.generic)
        for photo in ("own", "generic", "shuffled")
    }
    assert photos["own"] is case.room
    assert photos["generic"].kind == "office"
    assert photos["shuffled"] is case.other
    assert {part for variant in VARIANTS.values() for part in variant.without} <= set(PARTS)
    assert VARIANTS["shuffled photo"].trained_as == VARIANTS["another motion"].trained_as == VARIANTS[WHOLE]
    assert VARIANTS["hypernetwork and INR, generic photo"].trained_as == VARIANTS["hypernetwork and INR"]
    assert len({slug(name) for name in VARIANTS}) == len(VARIANTS)


def test_another_motion_changes_the_input_and_not_the_truth(material: AblationMaterial):
    case = material.cases[0]
    other = OtherMotion(case.room, case.index, case.other, case.seed_of_plan, case.lighting)
    assert np.abs(other.joints[0] - case.joints[0]).max() > 0.1
    assert np.array_equal(other.truth.values, case.truth.values)


def test_a_variant_may_be_the_hypernetwork():
    assert isinstance(network_of(AblationVariant(power=True)), PowerNetwork)
    assert isinstance(network_of(VARIANTS[WHOLE]), WeaverNetwork)


def test_with_one_code_the_photo_changes_no_field(material: AblationMaterial):
    network = with_one_code(network_of(VARIANTS["hypernetwork and INR"]), material.generic)
    assert isinstance(network, PowerNetwork)
    one, other = (network.room_writer(torch.full((2, 512), value)) for value in (0.0, 1.0))
    assert torch.equal(one, other)
    assert one.shape == (2, NUM_WRITTEN)
