"""Plans: reproducible, and nothing held out occurs in training."""

from dataclasses import replace

import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_plan import ACTIVITIES, DatasetPlan, HeldOut, check_for_leaks
from mmweaver.motion.language.sentence import parse

PLAN = DatasetPlan(kinds=("office", "living_room", "dining_room"), lightings=("day",), num_layouts=10,
                   sequences_a_room=30)  # fmt: skip


def test_equal_plans_are_equal():
    assert PLAN.rooms() == PLAN.rooms()
    assert replace(PLAN, seed=1).rooms() != PLAN.rooms()


def test_every_sentence_is_parsed():
    for texts in ACTIVITIES.values():
        for text in texts:
            assert parse(text).steps


def test_all_splits_are_filled_and_none_leaks():
    rooms = PLAN.rooms()
    check_for_leaks(rooms)
    found = {sequence.split for room in rooms for sequence in room.sequences}
    assert found == {"train", "validation", "test_room", "test_layout", "test_person", "test_activity"}
    assert all(len(room.sequences) == 30 for room in rooms)


@pytest.mark.parametrize("split", ["test_person", "test_activity", "test_room"])
def test_a_leak_is_found(split: str):
    rooms = PLAN.rooms()
    leaky = []
    for room in rooms:
        sequences = tuple(replace(s, split="train") if s.split == split and s.index % 2 else s for s in room.sequences)
        leaky.append(replace(room, sequences=sequences))
    with pytest.raises(InputError, match="leak"):
        check_for_leaks(leaky)


def test_combinations_of_held_out_properties_are_not_generated():
    both = HeldOut().split(kind="living_room", layouts_after=5, person=0, activity="jumping")
    assert both == ""


def test_an_empty_plan_is_refused():
    with pytest.raises(InputError, match="at least one kind"):
        DatasetPlan(kinds=(), lightings=("day",))
