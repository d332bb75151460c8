"""How many everyday sentences does the default command make? 200, written before the grammar was changed.

python -m studies run strangers

The 200 are in studies/motion/sentences/strangers.txt, written by one person as a stranger might say them; the grammar
was developed on others. Each is parsed and composed in the bundled room with seed 0 and no other option. A sentence is
made whole where every clause is done, approximated where one is shown as something similar or left out. Refusals are
counted by their reason. The baseline is what the same command made before (commit 238a8a5).
"""

import argparse
import hashlib
from collections import Counter
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.models.methods import Physics
from mmweaver.motion.compose import compose
from mmweaver.propagation.static_paths import Propagation
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from studies.manifest import StudyRun
from studies.result_rows import complete_rows

SENTENCES = Path(__file__).parent / "sentences" / "strangers.txt"
BEFORE = 72 / 200  # made at commit 238a8a5, by the same steps
REASONS = {"names no activity": "unknown", "was found in the photo": "not in the room", "no room": "no room",
           "nobody can be": "not in the room", "at the same time": "at the same time"}  # fmt: skip


def outcome(weaver: Weaver, room: Room, text: str) -> tuple[str, str]:
    """ "done", "approximated" or "refused", and the message of a refusal."""
    try:
        request = weaver.request(text)
        plan = request.people[0].plan
        assert plan is not None
        made = compose(plan, room.scene, seed=0, range_window_m=request.range_window_m)
    except InputError as error:
        return "refused", str(error)
    return ("done" if all(clause.status == "done" for clause in made.clauses) else "approximated"), ""


def result_row(outcomes: list[tuple[str, str]], digest: str) -> dict[str, Any]:
    """Shares of the sentences, and the reasons of refusals."""
    count = Counter(kind for kind, _ in outcomes)
    reasons = Counter(
        next((short for words, short in REASONS.items() if words in message), "other")
        for kind, message in outcomes if kind == "refused"
    )  # fmt: skip
    n = len(outcomes)

    def share(part: int, definition: str, **more: Any) -> dict[str, Any]:
        return {"value": part / n, "n": n, "unit": "share", "definition": definition, "version": 1, **more}

    metrics = {"made": share(n - count["refused"], "sentences that the default command makes in the bundled room")}
    metrics["made_before"] = share(round(BEFORE * n), "the same at commit 238a8a5")
    metrics["done"] = share(count["done"], "made, every clause as it was said")
    metrics["approximated"] = share(count["approximated"], "made, a clause approximated or not shown, which is said")
    return {
        "dataset": {"name": f"{n} everyday sentences", "split": "all", "sha256": digest},
        "n": n,
        "seeds": [0],
        "reasons": dict(reasons.most_common()),
        "metrics": metrics,
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    """It has none."""


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    weaver = Weaver(Physics(Propagation(bounces=1, clutter=False)))
    room = weaver.sample_room()
    texts = SENTENCES.read_text(encoding="utf-8").splitlines()
    digest = hashlib.sha256(SENTENCES.read_bytes()).hexdigest()
    outcomes = [outcome(weaver, room, text) for text in texts]
    row = result_row(outcomes, digest)
    unknown = {"seconds": "see the manifest"}
    run.write("strangers", "default", config={"room": "bundled"}, rows=complete_rows([row], unknown=unknown))
