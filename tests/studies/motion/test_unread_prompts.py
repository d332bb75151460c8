"""Shares from judgements that are named by the prompts' digest."""

from studies.motion.unread_prompts import name_of, result_row


def test_shares_are_of_all_prompts_and_of_those_judged():
    prompts = ["a person waves", "a person claps", "a person teleports", "a person does a handstand"]
    judgements = {
        name_of(prompts[0]): {"reading": "wave", "verdict": "right"},
        name_of(prompts[1]): {"reading": "walk", "verdict": "wrong"},
    }
    row = result_row(prompts, judgements)
    values = {name: metric["value"] for name, metric in row["metrics"].items()}
    assert values == {"understood": 0.5, "wrong": 0.5, "said": 0.0, "in_part_today": 0.0, "understood_today": 0.5}
    assert row["read_otherwise_today"] == 1


def test_what_is_done_though_shown_otherwise_is_counted_where_it_was_judged():
    prompts = ["a person waves", "a person claps"]
    judgements = {
        name_of(prompts[0]): {"reading": "wave", "verdict": "said", "done_though": True},
        name_of(prompts[1]): {"reading": "clap", "verdict": "right"},
    }
    assert result_row(prompts, judgements)["metrics"]["recorded_done"]["value"] == 0.5
    del judgements[name_of(prompts[0])]["done_though"]
    assert "recorded_done" not in result_row(prompts, judgements)["metrics"]
