"""How many sentences of others are understood, and how many correctly? Sixteen draws, each read once.

python -m studies run unread_prompts --prompts prompts.txt --draw second

The file has one prompt a line; it is not part of the project. `first`: 231 examples of MoMask's and MoSa's demos, the
text prompts of MDM, the prompts of STMC's MTT (its first 16,000 characters), a curriculum of prompts for a generator
and pairs of captions that differ in one word. `second`: 111 prompts of the demos of T2M, MLD, MoLA, LADiff and SMooDi
and of an evaluation of HY-Motion. `captions`: 145 captions of HumanML3D's validation split (two stretches of its
labels in BABEL's form, from characters 40,000 and 800,000).
`third`: 106 prompts of a list for evaluation in English and Chinese and of the demos of MotionLCM, StableMoFusion and
FlowMDM. `captions_second`: 142 further captions (from characters 1,150,000 and 1,400,000); those from 150,000, 250,000,
400,000, 500,000, 600,000 and 700,000 were read to widen the grammar. `captions_third`: 210 further ones (from 90,000,
320,000 and 1,470,000), after those from 900,000, 980,000, 1,050,000, 1,100,000, 1,250,000 and 1,330,000 had been read
to widen it; `captions_fourth`: 218 (from 215,000, 1,200,000 and 1,290,000), after `captions_third` had;
those from 436,000, 530,000, 560,000, 580,000, 640,000 and 660,000 were read to widen it since. `strangers`:
the 150 sentences of studies/motion/sentences/strangers_second.txt, written for a radar by a language model that had not
seen the grammar: short ones, everyday ones and hard ones; `strangers_second`: the 150 of strangers_third.txt, by a
language model that had not seen it either, in the style of captions of motion capture; `strangers_third`: the 150 of
strangers_fourth.txt, likewise, after the other two had been used to mend the grammar (one was in strangers_third.txt,
too); `strangers_fourth`: the 150 of strangers_fifth.txt, after the other three had (two were in earlier files).
`captions_fifth`: 283 captions of people again (from 112,000, 275,000, 735,000 and 840,000, 16,000 characters each),
after all draws above had been used to mend the grammar; ten that an earlier draw holds, as they are or with left
and right swapped, are left out; that none stands so in a stretch that was read to widen it was not checked.
`captions_sixth`: 290 more (from 293,000, 752,000, 857,000 and 930,000), after `captions_fifth` had been used to mend
it; six that an earlier draw holds, so or swapped, are left out, and the same was not checked. `captions_seventh`:
283 more (from 452,000, 873,000, 954,000 and 1,010,000; at most the first 75 of each), after `captions_sixth` had been
used to mend the checks and those from 420,000, 516,000, 546,000 and 676,000 (16,000 characters each) had been read to
widen them; twelve that an earlier draw holds, so or swapped, are left out, and the same was not checked.
`captions_eighth`: 300 more (from 310,000, 470,000, 772,000, 1,000,000 and 1,028,000; at most the first 75 of each, 65
of the last), after `captions_seventh` had been used to mend the checks and records and those from 128,000 and 232,000
had been read to develop the records; 64 that an earlier draw holds, so or swapped, understood or not, are left out,
and the same was not checked. `captions_ninth`: 300 more: 175 from 486,000 to 498,000, 788,000 to 795,000, 889,000 to
895,000, 946,000 to 954,000, 970,000 to 975,000 and 1,044,000 to 1,045,000, and 125 that public code and papers quote,
in the order in which "a person is doing jumping jacks" and "person raises his left arm" find them (three further
strings set before were not needed; names of actions, prompts and answers of models among them; two without a person
left out), after `captions_eighth` and 320 sentences in its style by the developers had been used to mend what is shown
and recorded; those in an earlier draw, understood or not, or in 200 of these sentences, so or swapped, and repeats but
for case and full stop are left out. Each prompt counts once, without those read to widen the
grammar or in an earlier draw, or the same with left and right swapped.
Each draw was read once, after a commit had frozen the grammar (5a2a9e6 before the first, 0a28cc6 before the next two,
3755052 before the next two, abf0c79, 5af3c0b, eb79a6a, ea0c8b6, 8f1f1f1, b85c0dc, 41538419, 1f1fe4eb, a88c8ccf,
6808b0c9 and 2a8417a6 before the last eleven);
what was understood was evaluated by hand, once, as the sentences of KIT-ML are (`kitml`). Since `captions_ninth` a
difference is said only where the words of its own clause's record, done or not, or a note let a reader see it, and
`done_though` marks whatever stands in a clause that is done and is shown otherwise or not at all, said or not. The
verdicts are in results/unread_prompts/judgements*.json, named by the prompts' sha256.
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

DRAWS = {  # -> ending of the names of their files
    "first": "", "second": "_second", "captions": "_captions", "third": "_third",
    "captions_second": "_captions_second", "captions_third": "_captions_third", "captions_fourth": "_captions_fourth",
    "strangers": "_strangers", "strangers_second": "_strangers_second",
    "strangers_third": "_strangers_third", "strangers_fourth": "_strangers_fourth",
    "captions_fifth": "_captions_fifth", "captions_sixth": "_captions_sixth",
    "captions_seventh": "_captions_seventh", "captions_eighth": "_captions_eighth",
    "captions_ninth": "_captions_ninth",
}  # fmt: skip


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
    parser.add_argument("--draw", choices=tuple(DRAWS), default="first", help="whose judgements are counted")
    parser.add_argument("--prompts", type=Path, action=Reads, required=True, help="file with one prompt a line")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    prompts = [line for line in options.prompts.read_text(encoding="utf-8").splitlines() if line.strip()]
    path = run.out / "unread_prompts" / f"judgements{DRAWS[options.draw]}.json"
    judgements = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    digest = hashlib.sha256(options.prompts.read_bytes()).hexdigest()
    name = {"name": f"prompts of other projects, {options.draw} draw", "sha256": digest}
    rows = complete_rows(
        [{"dataset": name, **result_row(prompts, judgements)}], unknown={"seconds": "see the manifest"}
    )
    run.write("unread_prompts", f"reading{DRAWS[options.draw]}", config={}, rows=rows)
