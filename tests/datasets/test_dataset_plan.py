"""Plans: reproducible, and nothing held out occurs in training."""

from mmweaver.datasets.dataset_plan import ACTIVITIES, DatasetPlan, HeldOut
from mmweaver.motion.language.sentence import parse

PLAN = DatasetPlan(kinds=("office", "living_room", "dining_room"), lightings=("day",), num_layouts=10,
                   sequences_a_room=30)  # fmt: skip


def test_every_sentence_is_parsed():
    for texts in ACTIVITIES.values():
        for text in texts:
            assert parse(text).steps


def test_all_splits_are_filled_and_none_leaks():
    """No held-out kind, layout, person, activity or seed occurs in training."""
    rooms = PLAN.rooms()
    assert all(len(room.sequences) == 30 for room in rooms)
    held_out = {
        "validation": lambda room, one: room.kind,
        "test_room": lambda room, one: room.kind,
        "test_layout": lambda room, one: (room.kind, room.layout),
        "test_person": lambda room, one: one.person,
        "test_activity": lambda room, one: one.activity,
    }
    for split, held in held_out.items():
        tested, trained = (
            {held(room, one) for room in rooms for one in room.sequences if one.split == name}
            for name in (split, "train")
        )
        assert tested
        assert not tested & trained, split
    seeds = [one.seed for room in rooms for one in room.sequences]
    assert len(set(seeds)) == len(seeds)


def test_combinations_of_held_out_properties_are_not_generated():
    both = HeldOut().split(kind="living_room", layouts_after=5, person=0, activity="jumping")
    assert both == ""
