"""Rows are completed by what is common to them, and by what they are compared with."""

from studies.result_rows import COST, NONE_MEASURED, complete_rows, plan_dataset


def test_rows_are_compared_with_baselines_and_oracles_among_them():
    scores = {"zeros": 0.0, "weaver": 0.4, "realization": 0.6}
    rows = [{"method": name, "n": 2, "metrics": {"ra_ssim": {"value": value}}} for name, value in scores.items()]
    done = complete_rows(
        rows, dataset={"name": "x", "sha256": "0"}, seeds=[0], seconds={"all": 1.0}, baselines=("zeros",),
        oracles=("realization", "absent"),
    )  # fmt: skip
    metric = done[1]["metrics"]["ra_ssim"]
    assert (metric["value"], metric["baseline"], metric["oracle"]) == (0.4, {"zeros": 0.0}, {"realization": 0.6})
    assert metric["definition"]
    assert metric["unit"] == "1"
    assert "unknown" not in done[1]


def test_what_is_not_known_gets_its_reason():
    row = {"dataset": {"name": "x"}, "split": "test", "seeds": [0], "seconds": {}, "n": 1,
           "metrics": {"cpu_s": {"value": 1.0}, "energy_db": {"value": None}}}  # fmt: skip
    (done,) = complete_rows([row], unknown={"dataset.sha256": "made anew"})
    assert done["dataset"] == {"sha256": None, "name": "x", "split": "test"}
    assert done["unknown"]["metrics.cpu_s.baseline"] == COST
    assert done["unknown"]["metrics.energy_db.baseline"] == NONE_MEASURED
    assert "metrics.energy_db.value" in done["unknown"]


def test_a_metric_keeps_its_own_words_and_scores():
    row = {"method": "a", "n": 1, "metrics": {"accuracy": {"value": 1.0, "unit": "share", "baseline": {"chance": 0.1}}}}
    others = {"method": "b", "n": 1, "metrics": {"accuracy": {"value": 0.5}}}
    done = complete_rows([row, others], dataset={"name": "x", "sha256": "0"}, seeds=[], baselines=("b",))
    assert done[0]["metrics"]["accuracy"]["unit"] == "share"
    assert done[0]["metrics"]["accuracy"]["baseline"] == {"b": 0.5, "chance": 0.1}


def test_the_hash_of_a_plan_does_not_depend_on_its_order():
    assert plan_dataset({"a": 1, "b": 2}) == plan_dataset({"b": 2, "a": 1})
    assert plan_dataset({"a": 1})["sha256"] != plan_dataset({"a": 2})["sha256"]
