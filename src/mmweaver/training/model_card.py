"""Model cards: purpose, data, scores and limits of a weights file."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.checksums import sha256_of_file
from mmweaver.models.weights import WeightsCard

Figures = Mapping[str, Mapping[str, float]]  # {method: {column: value}}
OWN = "this network"  # key of the weights' own scores

FRONT = """---
license: {licence}
library_name: mmweaver
pipeline_tag: other
tags:
- radar
- mmwave
- fmcw
- mimo
- simulation
model-index: {index}
---

# {title}

{about}
"""
LIMITS = """
## What it is not for

- It has seen rooms, people and radar signals of mmWeaver's simulator{and_captures}; nothing here shows how close it
  comes to a recording of another room. Amplitudes are uncalibrated.
{limits}
- Not for decisions about people's safety or health.
"""


@dataclass(frozen=True, kw_only=True)
class Page:
    """Text common to the model cards of one recipe."""

    about: str
    limits: str
    unit: str  # unit of the scores


WEAVER = Page(
    unit="dB",
    about="""A network of mmWeaver: a photo of a room with depth and a person's joints in, the echoes that an FMCW MIMO
radar at the camera would receive out. Phases are sampled; the signal follows from the radar's point response.

    mmweaver generate --rgb rgb.png --depth depth.png --text "a person walks" --weights . --out walk/

```python
from mmweaver import Weaver

weaver = Weaver.from_pretrained(".")  # this folder, its weights.safetensors, or its name on the Hub
```""",
    limits="""- What the photo does not show is missing. Phases of surfaces and skin are sampled, not known.
- One radar ({radar}); others are rendered from the same echoes and have not been evaluated.""",
)
ACTIVITY = Page(
    unit="",
    about="""A recogniser of mmWeaver: which of its labels some frames of a radar show, from range-Doppler and
range-azimuth maps in decibels above the receiver's noise. It evaluates generated data, and its features are those
of the paper's perceptual loss.""",
    limits="- One radar ({radar}); its maps are scaled by that radar's constants; other radars need other weights.",
)


def model_card(
    card: WeightsCard, file: Path, *, data: str, evaluated_on: str, figures: Figures, page: Page = WEAVER
) -> str:
    """Formats a model card as Markdown with front matter.

    Args:
        card: Header of the weights.
        file: The weights.
        data: Sentence on the training data.
        evaluated_on: Sentence on the evaluation data.
        figures: Scores in `page.unit` by method, including OWN.
        page: Text of the recipe. Default: that of the weaver.

    Returns:
        Text of the card.
    """
    lines = [
        FRONT.format(
            licence=card.licence.lower(),
            title=f"mmweaver {card.recipe}",
            about=page.about,
            index=_index(card, figures),
        ),
        "## Data",
        "",
        data,
        "",
        "## Scores",
        "",
        evaluated_on,
        "",
        *_table(figures, page.unit),
        "",
        f"The loss there is {card.validation_loss:.3f}, the least of the run.",
        "",
        "## Facts",
        "",
        "| | |",
        "| --- | --- |",
        f"| file | `{file.name}`, {file.stat().st_size:,} bytes, sha256 `{sha256_of_file(file)}` |",
        f"| licence | {card.licence} |",
        f"| data | sha256 of its plan `{card.dataset_sha256}` |"
        if not card.tuned_from
        else f"| data | sha256 of the captures `{card.dataset_sha256}` |",
        f"| radar | {card.radar} |",
        f"| steps | {card.steps:,}, seed {card.seed} |",
        f"| made by | mmweaver {card.mmweaver_version} |",
        *([f"| fine-tuned from | tensors of sha256 `{card.tuned_from}` |"] if card.tuned_from else []),
        *(f"| {name} | {value} |" for name, value in card.settings.items() if name not in ("name", "steps", "seed")),
    ]
    captures = " and the captures it was tuned on" if card.tuned_from else ""
    limits = page.limits.format(radar=card.radar)
    return "\n".join(lines) + "\n" + LIMITS.format(and_captures=captures, limits=limits)


def _index(card: WeightsCard, figures: Figures) -> str:
    """Scores of this network for the Hub, as one line of JSON, which is also YAML."""
    scores = [
        {"type": column, "value": round(value, 4), "name": column.replace("_", " ")}
        for column, value in figures[OWN].items()
    ]
    dataset = {"type": "mmweaver-validation", "name": "Validation, as under Scores"}
    return json.dumps(
        [{"name": card.recipe, "results": [{"task": {"type": "other"}, "dataset": dataset, "metrics": scores}]}]
    )


def _table(figures: Figures, unit: str) -> list[str]:
    columns = list(dict.fromkeys(column for row in figures.values() for column in row))
    ending = f", {unit}" if unit else ""
    head = ["| | " + " | ".join(column.replace("_", "-") + ending for column in columns) + " |"]
    head.append("| --- |" + " --- |" * len(columns))
    digits = 2 if unit == "dB" else 4
    rows = {who: " | ".join(f"{row[column]:.{digits}f}" for column in columns) for who, row in figures.items()}
    return head + [f"| {who} | {cells} |" for who, cells in rows.items()]
