"""Training of a small MotionGPT's language model: from a sentence to the tokens of its motion."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.seeding import stream
from mmweaver.motion.motiongpt.language_model import build_t5
from mmweaver.training.trainer import Resumable
from studies.motion.motion_tokenizer import REPORT_EVERY

if TYPE_CHECKING:
    from transformers import T5ForConditionalGeneration

IGNORED, END = -100, 1


@dataclass(frozen=True, kw_only=True)
class LanguageRecipe:
    """How the language model is trained."""

    steps: int = 1500
    batch: int = 48
    learning_rate: float = 1.5e-3
    warm_up: int = 50
    seed: int = 0


def train_language(
    pairs: list[tuple[list[int], list[int]]],
    sizes: dict[str, Any],
    first_motion_id: int,
    codes: int,
    recipe: LanguageRecipe,
    state_file: Path | None = None,
) -> "T5ForConditionalGeneration":
    """A T5 trained on (word ids, motion codes); with `state_file` its state is saved and resumed."""
    torch.manual_seed(recipe.seed)
    model = build_t5(sizes).train()
    optimiser = torch.optim.AdamW(model.parameters(), lr=recipe.learning_rate, weight_decay=0.01)
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: _rate(step, recipe))
    work = Resumable(state_file, {"model": model, "optimiser": optimiser, "schedule": schedule})
    for step in work.steps(recipe.steps):
        rng = stream(recipe.seed, "motion language", "batch", step)
        torch.manual_seed(int(rng.integers(2**31)))  # for dropout, so that a resumed run equals an uninterrupted one
        chosen = [pairs[int(k)] for k in rng.integers(len(pairs), size=recipe.batch)]
        words, labels = _padded([words for words, _ in chosen], 0), _labels(chosen, first_motion_id, codes)
        loss = model(input_ids=words, attention_mask=(words != 0).long(), labels=labels).loss
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimiser.step()
        schedule.step()
        if work.done % REPORT_EVERY == 0:
            work.history.append({"step": work.done, "loss": float(loss.detach())})
    return model.eval()


def _rate(step: int, recipe: LanguageRecipe) -> float:
    rising = min((step + 1) / recipe.warm_up, 1.0)
    return rising * (0.05 + 0.95 * 0.5 * (1 + float(np.cos(np.pi * min(step / recipe.steps, 1.0)))))


def _labels(chosen: list[tuple[list[int], list[int]]], first: int, codes: int) -> Tensor:
    """Label ids (sequence, token): start, codes, end of motion, end of sentence."""
    rows = [[first + codes, *(first + code for code in motion), first + codes + 1, END] for _, motion in chosen]
    return _padded(rows, IGNORED)


def _padded(rows: list[list[int]], fill: int) -> Tensor:
    longest = max(len(row) for row in rows)
    return torch.tensor([row + [fill] * (longest - len(row)) for row in rows])
