"""A labelled set: the same places and people for every label, resumable, nothing lost."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.datasets.activity_store import bytes_of_signals, read_activity_set
from mmweaver.datasets.build_set import PARTS, split_of
from mmweaver.datasets.zarr_arrays import SHARD_BYTES
from tests.datasets.conftest import ACTIVITIES, OPTIONS, builder


def test_every_label_has_the_same_places_people_and_seeds(activity_set: Path):
    stored = read_activity_set(activity_set)
    of = {}
    for label in range(len(stored.label_names)):
        own = stored.columns["label"] == label
        order = np.argsort(stored.columns["draw"][own])
        of[label] = [tuple(stored.columns[name][own][order]) for name in ("place", "subject", "heading", "height")]
    assert of[0] == of[1] == of[2]
    assert len(stored) == 18


def test_people_start_where_they_were_asked_to(activity_set: Path):
    stored = read_activity_set(activity_set)
    start_m = stored.joints_m[:, 0, joint("pelvis"), :2]
    for draw in range(OPTIONS.each):
        own = start_m[stored.columns["draw"] == draw]
        assert np.linalg.norm(own - own.mean(axis=0), axis=1).max() < 0.15


def test_no_leak_is_found_and_inherent_ones_are_named(activity_set: Path):
    report = json.loads((activity_set / "leaks.json").read_text())
    assert report["verdict"] == "leaks: none found"
    assert {"start_place", "heading", "person", "duration", "tempo", "file_size", "order"} <= set(report["of"])
    assert "cannot_be_avoided" in report["of"]["energy"]
    assert report["of"]["start_posture"]["leaks"]
    assert "start_posture" in report["inherent"]


def test_signals_lie_in_shards_of_sequences_of_one_size(activity_set: Path):
    stored = read_activity_set(activity_set)
    sizes = bytes_of_signals(activity_set, len(stored))
    shards = sorted(file.stat().st_size for file in (activity_set / "sequences.zarr/iq/c").rglob("*") if file.is_file())
    assert sizes == [shards[1]] * 17 + [shards[0]]
    assert shards[1] <= SHARD_BYTES + 2**12
    assert abs(shards[1] - 17 * shards[0]) < 2**13  # but their indices


def test_a_stopped_run_goes_on_with_the_same_bits(activity_set: Path, tmp_path: Path):
    made = builder(tmp_path / "set", replace(OPTIONS, each=2))
    seen = []

    def stop(done: int, _: int) -> None:
        seen.append(done)
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        made.make(stop)
    assert len(list((tmp_path / "set" / PARTS).glob("*.npz"))) == 3
    with pytest.raises(InputError, match="is not complete"):
        read_activity_set(tmp_path / "set")
    again = builder(tmp_path / "set", replace(OPTIONS, each=2))
    again.command += " --quiet"
    again.make()
    whole = tmp_path / "again"
    builder(whole, replace(OPTIONS, each=2)).make()
    assert (whole / "SHA256SUMS").read_text() == (tmp_path / "set" / "SHA256SUMS").read_text()
    assert not (whole / PARTS).exists()


def test_other_settings_are_refused(activity_set: Path, tmp_path: Path):
    copy = tmp_path / "set"
    shutil.copytree(activity_set, copy)
    with pytest.raises(InputError, match="other settings"):
        builder(copy, replace(OPTIONS, seed=1)).make()


def test_a_finished_set_is_left_alone(activity_set: Path):
    before = (activity_set / "SHA256SUMS").stat().st_mtime_ns
    (activity_set / "parts").mkdir()  # where a kill came before they were removed
    builder(activity_set).make()
    assert (activity_set / "SHA256SUMS").stat().st_mtime_ns == before
    assert not (activity_set / "parts").exists()


def test_an_activity_without_a_place_is_named_before_anything_is_written(tmp_path: Path):
    made = builder(tmp_path / "set", OPTIONS)
    made._obstacle = lambda draw, label: "'a person walks': no room" * (label == 1)  # type: ignore[method-assign]
    with pytest.raises(InputError, match=r"room 0 .*'a person walks'"):
        made.make()
    assert not (tmp_path / "set").exists()


def test_whoever_is_drawn_does_all_activities_where_sentences_describe_different_people(tmp_path: Path):
    mixed = builder(tmp_path, OPTIONS, ACTIVITIES + 'talking = ["an old woman talks on the phone"]\n')
    assert mixed.ignored_descriptions == ["old woman"]
    of_draw: dict[int, set[str]] = {}
    for one in mixed.plan:
        plan = mixed.request_of(one).people[0].plan
        of_draw.setdefault(one.draw.index, set()).add(repr(plan.person))
    assert {len(people) for people in of_draw.values()} == {1}
    alike = builder(tmp_path, OPTIONS, '[activities]\na = "a child waves"\nb = "a child claps"\n')
    assert alike.ignored_descriptions == []
    assert alike.request_of(alike.plan[0]).people[0].plan.person.age == "child"


def test_the_cost_counts_what_is_missing(tmp_path: Path):
    one = builder(tmp_path / "set", OPTIONS)
    cost = one.cost()
    assert cost.sequences == len(one.plan) == sum(cost.splits.values())
    one.make()
    stored = sum(file.stat().st_size for file in (tmp_path / "set").rglob("*") if file.is_file())
    assert cost.disk_bytes == pytest.approx(stored, rel=0.3)
    assert one.cost().sequences == 0


def test_splits_keep_groups_whole():
    groups = [number % 10 for number in range(100)]
    split = split_of(groups, "subject", 0)
    assert {name: len({g for g, s in zip(groups, split, strict=True) if s == name}) for name in set(split)} == {
        "train": 6, "validation": 2, "test": 2,
    }  # fmt: skip
    for group in range(10):
        assert len({s for g, s in zip(groups, split, strict=True) if g == group}) == 1
    assert set(split_of([0, 1, 0, 1], "room", 0)) == {"train"}
