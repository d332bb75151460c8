"""Is any damage of a data set accepted? Files deleted, cut, or with one bit flipped, at random places."""

import argparse
import hashlib
import random
import shutil
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.datasets.dataset_store import read_rooms
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.schema import metric
from studies.study import Reads

KINDS = ("deleted", "bit", "cut")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, nargs="+", action=Reads, required=True, help="sets of mmweaver dataset")
    parser.add_argument("--count", type=int, default=500, help="damages of each set (default 500)")
    parser.add_argument("--seed", type=int, default=0)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rows = []
    for data in options.data:
        counts: Counter[tuple[str, str]] = Counter()
        with tempfile.TemporaryDirectory() as work:
            copy = Path(work) / "set"
            shutil.copytree(data, copy)
            rng = random.Random(options.seed)
            for number in range(options.count):
                found = damage(copy, rng, KINDS[number % len(KINDS)])
                counts[found.kind, found.outcome] += 1
        for kind in KINDS:
            tried = sum(count for (one, _), count in counts.items() if one == kind)
            rows.append(
                {
                    "dataset": {"name": data.name, "sha256": None}, "n": tried, "seeds": [options.seed], "kind": kind,
                    "seconds": None,
                    "metrics": {
                        name: metric(counts[kind, outcome], "damages", definition)
                        for name, outcome, definition in (
                            ("refused", "refused", "refused in one line of at most 500 characters"),
                            ("accepted", "accepted", "read without an error"),
                        )
                    },
                    "unknown": {
                        "metrics.*.baseline": "a count that should be all or none",
                        "dataset.sha256": "the set is made anew by the command in the manifest",
                        "seconds": "not measured",
                    },
                }
            )  # fmt: skip
    run.write("trust", "damaged_sets", config={"count": options.count}, rows=complete_rows(rows))


@dataclass(frozen=True, kw_only=True)
class DamageOutcome:
    """What was damaged, and whether it was noticed."""

    file: str
    kind: str  # "deleted", "bit" or "cut"
    outcome: str  # "refused", "accepted", or the type of another exception


def damage(data: Path, rng: random.Random, kind: str) -> DamageOutcome:
    """Damages one file of a data set, reads all of the set, and restores the file."""
    # request.toml says how the set was made, and nobody reads it back
    file = rng.choice(sorted(path for path in data.rglob("*") if path.is_file() and path.name != "request.toml"))
    whole = file.read_bytes()
    file.unlink()
    if kind == "bit":
        at = rng.randrange(len(whole))
        file.write_bytes(whole[:at] + bytes([whole[at] ^ (1 << rng.randrange(8))]) + whole[at + 1 :])
    elif kind == "cut":
        file.write_bytes(whole[: rng.randrange(len(whole))])
    try:
        read_all(data)
        outcome = "accepted"
    except InputError as error:
        outcome = "refused" if len(str(error)) <= 500 and "\n" not in str(error) else "more than one line"
    except Exception as error:
        outcome = type(error).__name__
    file.write_bytes(whole)
    return DamageOutcome(file=str(file.relative_to(data)), kind=kind, outcome=outcome)


def read_all(data: Path) -> list[str]:
    """Reads everything that training uses; a digest of each room."""
    digests = []
    for room in read_rooms(data):
        digest = hashlib.sha256(repr((room.activity, room.text, room.split, room.person, room.seed)).encode())
        for values in (room.joints_m, room.joint_velocity_mps, room.photo.rgb, room.photo.depth_m, room.static):
            digest.update(values.tobytes())
        if room.photo.classes is not None:
            digest.update(room.photo.classes.index.tobytes())
        if room.geometry is None:
            for index in range(len(room.seed)):
                digest.update(room.cube(index).values.tobytes())
        else:
            digest.update(room.geometry.node_joints_m.tobytes())
            digest.update(repr(room.geometry.room.counts).encode())
            digest.update(repr(room.geometry.photographed.counts).encode())
        digests.append(digest.hexdigest())
    return digests
