"""Plans: reproducible, and nothing held out occurs in training."""

import hashlib
import subprocess
import sys
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_plan import ACTIVITIES, SPLITS, DatasetPlan, HeldOut
from mmweaver.motion.language.sentence import parse

PLAN = DatasetPlan(kinds=("office", "living_room", "dining_room"), lightings=("day",), num_layouts=10,
                   sequences_a_room=30)  # fmt: skip


def test_every_sentence_is_parsed():
    for texts in ACTIVITIES.values():
        for text in texts:
            assert parse(text).steps


@pytest.mark.parametrize("version", [3, 4])
def test_all_splits_are_filled_and_none_leaks(version: int):
    """No held-out kind, layout, person, activity or seed occurs in training."""
    plan = replace(PLAN, plan_version=version)
    rooms = plan.rooms()
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
    assert plan.check() == Counter(one.split for room in rooms for one in room.sequences)


def test_plans_of_earlier_versions_keep_their_seeds():
    """Sets made before stay what they were: the digests are those of mmweaver 0.3."""
    plan = DatasetPlan(kinds=("office", "living_room", "dining_room"), lightings=("day", "lamps"), num_layouts=4,
                       sequences_a_room=7, board="typical", plan_version=3)  # fmt: skip
    rooms = plan.rooms()
    assert hashlib.sha256(repr(rooms).encode()).hexdigest()[:16] == "8873705649d2fe55"
    assert hashlib.sha256(plan.to_json().encode()).hexdigest()[:16] == "81db802e65d0bf07"
    assert plan.board_of(rooms[1], AWR1843).name == "typical:1338157606"


def test_a_room_follows_from_its_number_alone_with_seeds_of_64_bits():
    """So a plan is resumed anywhere: one room in the middle is the same as in the whole plan."""
    rooms = PLAN.rooms()
    for number in (0, 17, 29):
        assert replace(PLAN).room(number) == rooms[number]
    seeds = np.array([one.seed for room in rooms for one in room.sequences], np.uint64)
    high = np.unpackbits(seeds.view(np.uint8).reshape(-1, 8), axis=1).mean(axis=0)
    assert np.abs(high - 0.5).max() < 6 * 0.5 / np.sqrt(len(seeds))  # every one of the 64 bits is random
    longer = replace(PLAN, sequences_a_room=40).room(17)
    assert longer.sequences[:30] == rooms[17].sequences
    (block,) = replace(PLAN, sequences_a_room=1000).blocks(range(1))
    persons = np.bincount(block.person[block.split == SPLITS.index("train")], minlength=6)
    assert np.all(np.abs(np.delete(persons, 3) - 140) < 5 * np.sqrt(140)), persons  # 3 is held out


def test_parts_cover_the_plan_once():
    for count in (1, 4, 7, 40):
        numbers = [number for part in range(1, count + 1) for number in PLAN.part(part, count)]
        assert numbers == list(range(PLAN.num_rooms))


def test_a_leak_is_found(monkeypatch: pytest.MonkeyPatch):
    """Splits that ignore a held-out person, layout or kind of room are seen in what is planned."""
    split, ignored = HeldOut.split, dict[str, object]()

    def careless(self: HeldOut, *, activity: str, **each: object) -> str:
        return split(self, activity=activity, **(each | (ignored if activity == "waving" else {})))

    for name, value in {"person": 0, "layouts_after": 9, "kind": "office"}.items():
        ignored.clear()
        ignored[name] = value
        with monkeypatch.context() as patch:
            patch.setattr(HeldOut, "split", careless)
            with pytest.raises(InputError, match=f"leak: {name.partition('s_')[0]}"):
                replace(PLAN).check()


def test_a_plan_that_holds_everything_out_is_refused():
    plan = replace(PLAN, withheld=HeldOut(validation_kinds=("office",), test_people=tuple(range(6))))
    with pytest.raises(InputError, match="holds out every sequence"):
        plan.check()


def test_ten_million_sequences_are_checked_in_seconds_and_little_memory():
    """In twenty CPU-seconds and 300 MB; a fifth of them here, in a process of its own."""
    code = (
        "import time; from pathlib import Path\n"
        "from mmweaver.datasets.dataset_plan import DatasetPlan\n"
        "plan = DatasetPlan(kinds=('office', 'gym'), lightings=('day',), num_layouts=8334)\n"
        "start = time.process_time()\n"
        "assert sum(plan.check().values()) == 2_000_160\n"
        "status = Path('/proc/self/status')\n"
        "lines = status.read_text().splitlines() if status.exists() else ['VmHWM: 0 kB']\n"
        "peak = [line.split()[1] for line in lines if line.startswith('VmHWM')]\n"
        "print(time.process_time() - start, *peak)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    seconds, kilobytes = map(float, done.stdout.split())
    assert seconds < 4.0
    assert kilobytes < 300_000


def test_combinations_of_held_out_properties_are_not_generated():
    both = HeldOut().split(kind="living_room", layouts_after=5, person=0, activity="jumping")
    assert both == ""
