"""Where documents promise something: parts of the package, their shares of a sample, and the pages that promise."""

import random
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from tools.mutants.mutations import Mutation, changes_the_program, mutations

PACKAGE = Path("src/mmweaver")


@dataclass(frozen=True)
class Part:
    share: float
    folders: tuple[str, ...]
    pages: tuple[str, ...]  # of docs/, without .md


PARTS = {
    "core": Part(14, ("core",), ("conventions", "security", "radars", "board")),
    "propagation": Part(15, ("propagation",), ("conventions", "radar_primer", "several_people", "several_radars")),
    "signal": Part(10, ("signal",), ("conventions", "radar_primer", "features")),
    "files": Part(9, ("io",), ("formats", "captures", "export")),
    "motion": Part(14, ("motion",), ("motion", "motion_files", "evidence/motiongpt")),
    "scene": Part(10, ("scene",), ("photos", "rooms")),
    "compression": Part(9, ("compression",), ("mmw_format",)),
    "datasets": Part(6, ("datasets",), ("training", "own_room_dataset")),
    "recordings": Part(4, ("recordings",), ("captures",)),
    "recognition": Part(7, ("recognition",), ("recognise", "pose", "evidence/zero_shot")),
    "evaluation": Part(6, ("evaluation",), ("board", "compare", "evidence/README")),
    "models": Part(6, ("models", "training"), ("evidence/weaver", "fields", "training")),
    "results": Part(5, ("weaver",), ("generate", "evidence/limits", "extend")),
    "command line": Part(5, ("cli", "studio"), ("generate", "evidence/limits", "studio")),
}  # fmt: skip
# pictures, and what is measured for the documents alone
LEFT_OUT = ("*picture.py", "*sheet.py", "*page.py", "run_log.py", "model_card.py")


@dataclass(frozen=True)
class Place:
    part: str
    file: str
    mutation: Mutation


def sampled_places(root: Path, seed: int, count: int) -> list[Place]:
    """Of each part its share; within a part every kind of mutation is equally likely, and a line is taken once."""
    total = sum(part.share for part in PARTS.values())
    rng = random.Random(seed)
    wanted = {name: int(count * part.share / total) for name, part in PARTS.items()}
    for name in rng.sample(list(PARTS), count - sum(wanted.values())):  # fewer than there are parts
        wanted[name] += 1
    return [place for name, number in wanted.items() for place in _sample(root, _candidates(root, name), number, rng)]


def _candidates(root: Path, part: str) -> dict[str, list[Place]]:
    by_kind: dict[str, list[Place]] = defaultdict(list)
    for folder in PARTS[part].folders:
        place = root / PACKAGE / folder
        for path in [place] if place.is_file() else sorted(place.rglob("*.py")):
            if not any(path.match(pattern) for pattern in LEFT_OUT):
                file = path.relative_to(root).as_posix()
                for mutation in mutations(path.read_bytes()):
                    by_kind[mutation.kind].append(Place(part, file, mutation))
    return by_kind


def _sample(root: Path, by_kind: dict[str, list[Place]], number: int, rng: random.Random) -> list[Place]:
    taken: dict[tuple[str, int], Place] = {}
    while len(taken) < number:
        place = rng.choice(by_kind[rng.choice(sorted(by_kind))])
        if changes_the_program((root / place.file).read_bytes(), place.mutation):
            taken.setdefault((place.file, place.mutation.line), place)
    return list(taken.values())
