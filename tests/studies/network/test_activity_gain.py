"""The gain study on a tiny data set: motions in the photographed room, the same for all; a gain that is one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.datasets.dataset_plan import ACTIVITIES, DatasetPlan
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from mmweaver.datasets.generate_rooms import generate_dataset
from mmweaver.models.activity_network import ActivityNetwork
from studies.network import activity_gain
from studies.network.activity_gain import (
    ALONE,
    GainStudy,
    Labelled,
    evaluated,
    few_of,
    gains,
    motions_in,
    rows_of,
    simulated_in,
    unseen_rooms,
)
from studies.network.room_cache import RoomCache

pytest.importorskip("zarr")


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "set"
    plan = DatasetPlan(
        kinds=("office", "living_room"), lightings=("day",), num_layouts=1, sequences_a_room=3, num_frames=4
    )
    generate_dataset(folder, plan, AWR1843)
    return folder


def _base(per_class: int, width: int) -> Labelled:
    label = torch.arange(12).repeat(per_class)
    return Labelled(frames=torch.randn(len(label), 4, width), label=label)


@pytest.mark.slow  # a whole study of one room; its scores and rows: the tests below
def test_rows_of_a_room(data: Path, tmp_path: Path):
    (room,) = unseen_rooms(read_rooms(data), read_plan(data), 5)
    assert room.name == "living_room_0"
    assert room.generic.kind == "office"
    motions = motions_in(room, 1, seed=0)
    assert {activity for activity, _ in motions} <= set(ACTIVITIES)
    assert len(motions) >= 10
    torch.manual_seed(0)
    network = ActivityNetwork(AWR1843).eval()
    methods = {
        "true_room": simulated_in(
            lambda one: one.true_scene(one.room), micro_seed=0, board_of=lambda one: one.own_board
        )
    }
    reported: list[int] = []
    base = _base(2, network.head.first.in_features)
    studies = {"all": GainStudy(network, base), "few": GainStudy(network, base, begins_anew=True)}
    cache = RoomCache(tmp_path, {})
    both = gains(
        studies, [room], methods, each=1, cache=cache, after=lambda one: reported.append(len(one["few"][ALONE]))
    )
    assert reported == [1]
    again = gains(studies, [room], {}, each=1, cache=cache)  # of what was cache
    assert not np.array_equal(both["all"]["true_room"], both["few"]["true_room"])
    found = both["all"]
    assert np.array_equal(again["all"]["true_room"], found["true_room"])
    rows = rows_of(found, [room.name])
    assert [row["method"] for row in rows] == [ALONE, "true_room"]
    assert rows[0]["metrics"]["gain"]["value"] == 0
    gain = rows[1]["metrics"]["gain"]["value"]
    assert gain == pytest.approx(float(found["true_room"][0, 0] - found[ALONE][0, 0]))


@pytest.mark.slow  # signals of a study
def test_a_room_has_the_board_of_its_data_set_and_generated_signals_another(data: Path):
    (ideal,) = unseen_rooms(read_rooms(data), read_plan(data), 5)
    assert ideal.own_board.is_ideal
    assert ideal.other_board.is_ideal
    plan = {**read_plan(data), "board": "typical"}
    typical = replace(ideal, plan=plan)
    whole = DatasetPlan(kinds=("office", "living_room"), lightings=("day",), num_layouts=1, board="typical")
    (spec,) = (room for room in whole.rooms() if room.kind == "living_room")
    assert typical.own_board.to_json() == whole.board_of(spec, AWR1843).to_json()
    assert typical.other_board.to_json() != typical.own_board.to_json()


def test_rows_hold_the_gain_over_training_elsewhere():
    alone, helped = (np.array(values) for values in ([[0.2, 2.0], [0.4, 1.0]], [[0.5, 1.0], [0.6, 0.5]]))
    rows = rows_of({ALONE: alone, "true_room": helped}, ["kitchen_0", "kitchen_1"])
    assert [(row["method"], row["num_rooms"]) for row in rows] == [(ALONE, 2), ("true_room", 2)]
    assert rows[0]["metrics"]["gain"]["value"] == 0
    assert rows[1]["metrics"]["gain"]["value"] == pytest.approx(0.25)
    assert rows[1]["metrics"]["log_loss_gain"]["value"] == pytest.approx(0.75)
    assert rows[1]["metrics"]["accuracy"]["baseline"] == {"chance": pytest.approx(1 / 12)}


def test_data_of_the_room_helps_where_the_room_differs(monkeypatch: pytest.MonkeyPatch):
    """In the room every activity looks like nothing elsewhere: only its own data can report."""
    monkeypatch.setattr(activity_gain, "STEPS", 60)
    torch.manual_seed(0)
    network = ActivityNetwork(AWR1843)
    width = network.head.first.in_features
    centres = 3 * torch.randn(12, width)

    def drawn(of: torch.Tensor, count: int) -> Labelled:
        label = torch.arange(12).repeat(count)
        return Labelled(frames=of[label][:, None] + 0.1 * torch.randn(len(label), 4, width), label=label)

    elsewhere, here = centres, 3 * torch.randn(12, width)
    base, test = drawn(elsewhere, 4), drawn(here, 2)
    study = GainStudy(network, base)
    alone, loss = evaluated(study, None, test, 0)
    helped, lower = evaluated(study, drawn(here, 4), test, 0)
    assert alone < 0.5
    assert helped > alone + 0.2
    assert lower < loss
    assert evaluated(study, None, test, 0) == (alone, loss)


def test_a_few_recordings_are_of_all_activities_and_a_head_that_begins_anew_knows_nothing():
    label = np.repeat(np.arange(12), 10)
    chosen = few_of(label, 24)
    assert len(set(chosen)) == 24
    assert np.array_equal(np.bincount(label[chosen]), np.full(12, 2))
    torch.manual_seed(0)
    network = ActivityNetwork(AWR1843)
    base = _base(1, network.head.first.in_features)
    old, new = (GainStudy(network, base, begins_anew=anew).head().state_dict() for anew in (False, True))
    assert torch.equal(old["first.weight"], network.head.first.weight)
    assert not torch.equal(new["first.weight"], old["first.weight"])
