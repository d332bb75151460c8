"""How many captions of other people are understood, and how many correctly? Five draws, each read once.

python -m studies run unread_prompts --prompts prompts.txt --draw captions_ninth

The file has one caption a line; it is not part of the project. Captions are of HumanML3D's validation split (its labels
in BABEL's form), from these characters of the file: `captions_fifth` 283 (from 112,000, 275,000, 735,000 and 840,000),
`captions_sixth` 290 (293,000, 752,000, 857,000, 930,000), `captions_seventh` 283 (452,000, 873,000, 954,000,
1,010,000), `captions_eighth` 300 (310,000, 470,000, 772,000, 1,000,000, 1,028,000), `captions_ninth` 175 (486,000 to
498,000, 788,000 to 795,000, 889,000 to 895,000, 946,000 to 954,000, 970,000 to 975,000, 1,044,000 to 1,045,000) and 125
that public code and papers quote. Captions in an earlier draw, as they are or with left and right swapped, are left
out. Each draw was read once, after a commit had frozen the grammar (41538419, 1f1fe4eb, a88c8ccf, 6808b0c9, 2a8417a6);
what was understood was annotated by hand as the sentences of KIT-ML are (`kitml`). The verdicts are in
results/unread_prompts/judgements*.json, named by the captions' sha256; in the ninth draw `done_though` marks what is
shown otherwise in a clause that is done.
"""

import argparse
import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import NOT_DONE
from mmweaver.motion.language.sentence import parse
from studies.manifest import StudyRun
from studies.motion.kitml import Judgements, reading_of, share
from studies.result_rows import complete_rows
from studies.study import Reads

DRAWS = tuple(f"captions_{one}" for one in ("fifth", "sixth", "seventh", "eighth", "ninth"))


def name_of(prompt: str) -> str:
    """What stands for a prompt in the judgements: twelve digits of its sha256."""
    return hashlib.sha256(prompt.strip().encode()).hexdigest()[:12]


def result_row(prompts: list[str], judgements: Judgements) -> dict[str, Any]:
    """Shares of the frozen grammar, from the judgements, and what today's grammar understands of the same prompts."""
    today, in_part = {}, 0
    for prompt in prompts:
        try:
            plan = parse(prompt, in_part=True)
        except InputError:
            continue
        today[name_of(prompt)] = reading_of(plan)
        in_part += any(clause.status == NOT_DONE for clause in plan.clauses)
    judged = [judgements[name] for name in map(name_of, prompts) if name in judgements]
    verdicts = Counter(one["verdict"] for one in judged)
    done_though = sum(bool(one.get("done_though")) for one in judged)
    return {
        "n": len(prompts),
        "seeds": [],
        "evaluated": len(judged),
        "read_otherwise_today": sum(today.get(name) != one["reading"] for name, one in judgements.items()),
        "metrics": {
            "understood": share(len(judged), len(prompts), "prompts that gave a plan, of all; frozen grammar"),
            "wrong": share(verdicts["wrong"], len(judged), "wrong by hand without a word, of those understood"),
            "said": share(verdicts["said"], len(judged), "shown otherwise or in part, which the clause's record says"),
            **(
                {"recorded_done": share(done_though, len(judged), "recorded as done though shown otherwise, by hand")}
                if done_though
                else {}
            ),
            "in_part_today": share(
                in_part, len(today), "with a clause that is not done, of those that give a plan today"
            ),
            "understood_today": share(len(today), len(prompts), "prompts that give a plan today, after what was found"),
        },
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--draw", choices=DRAWS, default=DRAWS[-1], help="whose judgements are counted")
    parser.add_argument("--prompts", type=Path, action=Reads, required=True, help="file with one prompt a line")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    prompts = [line for line in options.prompts.read_text(encoding="utf-8").splitlines() if line.strip()]
    path = run.out / "unread_prompts" / f"judgements_{options.draw}.json"
    judgements = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    digest = hashlib.sha256(options.prompts.read_bytes()).hexdigest()
    name = {"name": f"prompts of other projects, {options.draw} draw", "sha256": digest}
    rows = complete_rows(
        [{"dataset": name, **result_row(prompts, judgements)}], unknown={"seconds": "see the manifest"}
    )
    run.write("unread_prompts", f"reading_{options.draw}", config={}, rows=rows)
