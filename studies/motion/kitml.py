"""How many sentences written by other people are understood, and how many correctly? 6,082 sentences of KIT-ML.

python -m studies run kitml --sentences <folder of kitml_text>
python -m studies run kitml --sentences <folder> --list        # the sentences to annotate, with their readings

The sentences are split by motion into a half on which the lexicon was developed and a half for checking. Of this second
half 300 drawn uniformly are counted. Of the others, those in no earlier sample, 1,100 were read to widen the grammar
(the development draw). Two samples of 300 were drawn of those that nobody had read (the sixth and the seventh), each
after a freeze. Now 300 are drawn of what is left: 97 of these, and 209 of the uniform draw that no sample had held. The
understood ones are annotated by hand, once. Right: every movement that the sentence names is shown in its order, with
its side, direction, hand or foot where one is given. Said: some of it is shown otherwise or not, and the clause
says so. Wrong: the same, without a word. The verdicts are in results/kitml/judgements.json with the readings they were
given for and evaluate the grammar of that day; how many of today's readings have no verdict is counted. Seven earlier
samples (judgements_first.json and so on) are unchanged and evaluate earlier grammars; judgements_seen_since.json has
verdicts of today's readings of the last 300 that differ, which is no blind evaluation. docs/motion.md says what else
limits the figures.
"""

import argparse
import hashlib
import json
import sys
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

DRAWN = 300  # sentences of the checking half that were never judged before
Judgements = dict[str, dict[str, Any]]  # name -> reading, verdict (right | said | wrong), why, done_though
DEVELOPED = 1100  # sentences of the checking half that were read to widen the grammar
SEED, SEVENTH_SEED, SIXTH_SEED, UNIFORM_SEED, DEVELOPMENT_SEED = 2031, 2030, 2029, 2028, 4242
BEFORE_DEVELOPMENT = ("first", "second", "third", "fourth", "fifth")
EARLIER = (*BEFORE_DEVELOPMENT, "sixth", "seventh")


@dataclass(frozen=True, kw_only=True)
class Sentence:
    """One annotation: its id, the motion it belongs to, its words."""

    name: str
    motion: str
    text: str

    @property
    def is_for_checking(self) -> bool:
        """Half of the motions, by a hash of their number; the lexicon was developed without their sentences."""
        return hashlib.sha256(self.motion.encode()).digest()[0] % 2 == 1


def sentences_of(path: Path) -> list[Sentence]:
    """All sentences except those of the mirrored motions, which are the same with sides swapped."""
    annotations = json.loads(path.read_text(encoding="utf-8"))
    return [
        Sentence(name=note["seg_id"], motion=motion, text=note["text"])
        for motion, record in annotations.items()
        if not motion.startswith("M")
        for note in record["annotations"]
    ]


def reading_of(plan: MotionPlan) -> str:
    """A plan on one line: 'walk forwards x4 | turn left'."""
    parts = []
    for step in plan.steps:
        doing = step.upper if step.lower == "stand" and step.upper else "+".join(filter(None, (step.lower, step.upper)))
        said = [
            doing,
            step.direction,
            f"{step.hand} hand" if step.hand else "",
            f"{step.foot} foot" if step.foot else "",
        ]
        said += [f"bend {step.arc_deg:g}" if step.arc_deg else "", f"angle {step.turn_deg:g}" if step.turn_deg else ""]
        said += [step.style, f"to {step.target}" if step.target else "", f"facing {step.facing}" if step.facing else ""]
        said += [{-1: "slowly", 0: "", 1: "fast"}[step.speed], f"x{step.count}" if step.count else ""]
        parts.append(" ".join(word for word in said if word))
    return " | ".join(parts)


def understood(sentences: list[Sentence]) -> dict[str, str]:
    """{name: reading} of the sentences that are understood."""
    found = {}
    for sentence in sentences:
        try:
            found[sentence.name] = reading_of(parse(sentence.text, in_part=True))
        except InputError:
            continue
    return found


def fresh_draw(checking: list[Sentence], before: Collection[str]) -> tuple[list[str], list[str]]:
    """Names of the development draw and of the 300 to annotate, which nobody has read.

    `before`: what was judged before the development draw. The sixth and seventh samples, of sentences left by that
    draw, are left out of the 300, with those of their sentences that were refused.
    """
    uniform = uniform_draw(checking)
    free = [sentence.name for sentence in checking if sentence.name not in before and sentence.name not in set(uniform)]
    order = stream(DEVELOPMENT_SEED, "kitml", "development draw").permutation(len(free))
    developed, rest = ([free[k] for k in part] for part in (order[:DEVELOPED], order[DEVELOPED:]))
    left = [rest[k] for k in stream(SIXTH_SEED, "kitml", "third fresh").permutation(len(rest))[DRAWN:]]
    unread = [left[k] for k in stream(SEVENTH_SEED, "kitml", "seventh").permutation(len(left))[DRAWN:]]
    unread += [name for name in uniform if name not in before]
    return developed, [unread[k] for k in stream(SEED, "kitml", "eighth").permutation(len(unread))[:DRAWN]]


def uniform_draw(checking: list[Sentence]) -> list[str]:
    """300 sentences of the checking half, understood or not, judged before or not."""
    return [checking[k].name for k in stream(UNIFORM_SEED, "kitml", "uniform").permutation(len(checking))[:DRAWN]]


def result_row(
    sentences: list[Sentence],
    judgements: Judgements,
    before: dict[str, Judgements],
    digest: str,
    since: Judgements | None = None,
) -> dict[str, Any]:
    """Shares over all sentences and each half, and the shares of wrong ones by hand annotation."""
    readings = understood(sentences)
    checking = [sentence for sentence in sentences if sentence.is_for_checking]
    developed = [sentence for sentence in sentences if not sentence.is_for_checking]
    developed_on, drawn = fresh_draw(checking, _judged_before_development(before))
    names = [name for name in drawn if name in readings]
    void = sum(judgements.get(name, {}).get("reading") != readings[name] for name in names)
    verdicts = Counter(one["verdict"] for one in judgements.values())
    seen = {_plain(sentence.text) for sentence in developed}
    metrics = {
        "understood": share(len(readings), len(sentences), "sentences that give a plan, of all"),
        "understood_checking_half": share(
            sum(s.name in readings for s in checking), len(checking), "the same, of the half not developed on"
        ),
        "understood_draw": share(
            sum(name in readings for name in uniform_draw(checking)), DRAWN, "the same, of 300 drawn from that half"
        ),
        "understood_development_draw": share(
            sum(name in readings for name in developed_on), len(developed_on), "the same, of those read to widen it"
        ),
        "understood_fresh_draw": share(
            len(names), len(drawn), "the same, of those drawn for annotation: none in an earlier sample, so harder"
        ),
        "understood_new_sentences": share(
            sum(s.name in readings for s in checking if _plain(s.text) not in seen),
            sum(_plain(s.text) not in seen for s in checking),
            "the same, of checking sentences whose words occur in no sentence of the other half",
        ),
        **{
            f"wrong_{name}_sample": share(
                sum(verdict["verdict"] == "wrong" for verdict in earlier.values()),
                len(earlier),
                "an earlier sample of the checking half, annotated before the faults found in it were fixed",
            )
            for name, earlier in before.items()
        },
        "understood_frozen": share(len(judgements), len(drawn), "the same draw, by the grammar that was annotated"),
        "wrong": share(
            verdicts["wrong"],
            len(judgements),
            "wrong by hand without a word, of those the annotated grammar understood",
        ),
        "said": share(verdicts["said"], len(judgements), "shown otherwise or in part, which the clause's record says"),
        **_seen_since(judgements, since or {}, {name: readings[name] for name in names}),
    }
    activities = Counter(part.split()[0] for reading in readings.values() for part in reading.split(" | "))
    return {
        "dataset": {"name": "KIT-ML sentences", "sha256": digest, "split": "motions by hash, half for checking"},
        "n": len(sentences),
        "seeds": [SEED],
        "evaluated": len(judgements),
        "evaluated_void": void,
        "activities_named": dict(activities.most_common()),
        "metrics": metrics,
    }


def _seen_since(judgements: Judgements, since: Judgements, readings: dict[str, str]) -> dict[str, Any]:
    """The share of wrong ones by today's grammar, of the draw that has been read since; those without a verdict count.

    A verdict holds for the reading that it was given for, whenever that was.
    """
    verdicts = Counter(
        next(
            (one["verdict"] for one in (since.get(name), judgements.get(name)) if one and one["reading"] == reading),
            "none",
        )
        for name, reading in readings.items()
    )
    bad = verdicts["wrong"] + verdicts["none"]
    what = "the same draw by today's grammar, all of it read since: wrong, or without a verdict; no measure of others"
    return {"wrong_seen_since": share(bad, len(readings), what)} if since else {}


def share(part: int, whole: int, definition: str) -> dict[str, Any]:
    """A share with its 95 % Wilson interval."""
    share = part / max(whole, 1)
    z = 1.96
    centre = (share + z * z / (2 * max(whole, 1))) / (1 + z * z / max(whole, 1))
    half = (
        z / (1 + z * z / max(whole, 1)) * (share * (1 - share) / max(whole, 1) + (z / (2 * max(whole, 1))) ** 2) ** 0.5
    )
    return {
        "value": round(share, 4), "interval_95": [round(max(centre - half, 0.0), 4), round(min(centre + half, 1.0), 4)],
        "n": whole, "unit": "share", "definition": definition, "version": 1,
    }  # fmt: skip


def _plain(text: str) -> str:
    return " ".join("".join(letter if letter.isalnum() else " " for letter in text.lower()).split())


def measure(run: StudyRun, folder: Path) -> Path:
    """Writes results/kitml/reading.json from the hand annotations in results/kitml/judgements.json."""
    path = folder / "kitml_annotations.json"
    judgements, before = _judgements(run.out, "judgements"), _before(run.out)
    digest, since = hashlib.sha256(path.read_bytes()).hexdigest(), _judgements(run.out, "judgements_seen_since")
    row = result_row(sentences_of(path), judgements, before, digest, since)
    unknown = {"seconds": "see the manifest"}
    return run.write("kitml", "reading", config={"drawn": DRAWN}, rows=complete_rows([row], unknown=unknown))


def _judgements(out: Path, name: str) -> Judgements:
    path = out / "kitml" / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def _before(out: Path) -> dict[str, Judgements]:
    return {name: _judgements(out, f"judgements_{name}") for name in EARLIER}


def _judged_before_development(before: dict[str, Judgements]) -> set[str]:
    return {name for sample in BEFORE_DEVELOPMENT for name in before.get(sample, ())}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--sentences", type=Path, action=Reads, required=True, help="folder with kitml_annotations.json"
    )
    parser.add_argument("--list", action="store_true", help="only list the sentences to annotate, as JSON")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    if options.list:
        sentences = sentences_of(options.sentences / "kitml_annotations.json")
        readings, texts = understood(sentences), {s.name: s.text for s in sentences}
        _, drawn = fresh_draw([s for s in sentences if s.is_for_checking], _judged_before_development(_before(run.out)))
        names = [name for name in drawn if name in readings]
        json.dump([{"name": n, "text": texts[n], "reading": readings[n]} for n in names], sys.stdout, indent=1)
        return
    measure(run, options.sentences)
