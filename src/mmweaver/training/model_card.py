"""The page that goes with a weight file: what it is, from which data, how good, what it is not for."""

import hashlib
from collections.abc import Mapping
from pathlib import Path

from mmweaver.models.weights import WEIGHTS_FILE, WeightsCard

Figures = Mapping[str, Mapping[str, float]]  # {whose: {column: value}}

FRONT = """---
license: {licence}
library_name: mmweaver
tags:
- radar
- mmwave
- fmcw
- mimo
- simulation
---

# {title}

A network of mmWeaver: a photo of a room with depth and a person's joints in, the echoes that an FMCW MIMO radar at the
camera would see out. Phases are drawn, the signal follows from the radar's own response.

    mmweaver generate --rgb rgb.png --depth depth.png --text "a person walks" --method weaver --weights . --out walk/

```python
from mmweaver import Weaver

weaver = Weaver.from_pretrained(".")  # this folder, its {file}, or its name on the Hub
```
"""
LIMITS = """
## What it is not for

- It has seen rooms, people and radar signals made up by mmWeaver's simulator{and_captures}; nothing here says how near
  it comes to a recording of another room. Amplitudes are uncalibrated.
- What the photo does not show is not there. Phases of surfaces and skin are drawn, not known.
- One radar ({radar}); others are rendered from the same echoes and have not been judged.
- Not for decisions about people's safety or health.
"""


def model_card(card: WeightsCard, file: Path, *, data: str, judged_on: str, figures: Figures) -> str:
    """The page as Markdown with a front matter. `data`, `judged_on`: sentences; `figures`: rows of scores in dB."""
    lines = [
        FRONT.format(
            licence=card.licence.lower(), title=f"mmweaver {card.recipe}", file=WEIGHTS_FILE
        ),
        "## Data", "", data, "", "## How good", "", judged_on, "",
        *_table(figures), "",
        f"The loss there is {card.validation_loss:.3f}, the least of the run.", "", "## Facts", "",
        "| | |", "| --- | --- |",
        f"| file | `{file.name}`, {file.stat().st_size:,} bytes, sha256 `{_sha256(file)}` |",
        f"| licence | {card.licence} |",
        f"| data | sha256 of its plan `{card.dataset_sha256}` |" if not card.tuned_from else
        f"| data | sha256 of the captures `{card.dataset_sha256}` |",
        f"| radar | {card.radar} |",
        f"| steps | {card.steps:,}, seed {card.seed} |",
        f"| made by | mmweaver {card.mmweaver_version} |",
        *([f"| fine-tuned from | tensors of sha256 `{card.tuned_from}` |"] if card.tuned_from else []),
        *(f"| {name} | {value} |" for name, value in card.settings.items() if name not in ("name", "steps", "seed")),
    ]  # fmt: skip
    told = " and the captures it was tuned on" if card.tuned_from else ""
    return "\n".join(lines) + "\n" + LIMITS.format(and_captures=told, radar=card.radar)


def _table(figures: Figures) -> list[str]:
    columns = list(dict.fromkeys(column for row in figures.values() for column in row))
    head = ["| | " + " | ".join(f"{column.replace('_', '-')}, dB" for column in columns) + " |"]
    head.append("| --- |" + " --- |" * len(columns))
    return head + [f"| {who} | " + " | ".join(f"{row[c]:.2f}" for c in columns) + " |" for who, row in figures.items()]


def _sha256(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
