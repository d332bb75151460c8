"""Training of the motion tokenizer: reconstruction, codebook by exponential moving averages, reset of idle codes.

Reference: Zhang et al., T2M-GPT, CVPR 2023, 3.1 (smooth L1 on features, more weight on joints; EMA and reset).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn import functional

from mmweaver.core.seeding import stream
from mmweaver.motion.motiongpt.tokenizer import Codebook, MotionTokenizer, TokenizerConfig
from mmweaver.training.trainer import Resumable

REPORT_EVERY = 50  # steps
JOINTS = slice(4, 67)


@dataclass(frozen=True, kw_only=True)
class TokenizerRecipe:
    """How the tokenizer is trained; features arrive normalised."""

    steps: int = 3000
    batch: int = 32
    frames: int = 48
    learning_rate: float = 6e-4
    commitment: float = 0.02
    joints_again: float = 0.5
    running: float = 0.99
    idle_below: float = 0.5
    seed: int = 0


def train_tokenizer(
    motions: list[np.ndarray],
    config: TokenizerConfig,
    recipe: TokenizerRecipe,
    state_file: Path | None = None,
) -> MotionTokenizer:
    """A tokenizer trained on motions (frame, feature) of any lengths. Same seed, same weights.

    With `state_file` its state is saved and resumed.
    """
    torch.manual_seed(recipe.seed)
    model = MotionTokenizer(config)
    optimiser = torch.optim.AdamW(model.parameters(), lr=recipe.learning_rate, weight_decay=1e-4)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, recipe.steps, eta_min=recipe.learning_rate / 20)
    means = RunningMeans(model.quantizer, recipe)
    work = Resumable(state_file, {"model": model, "optimiser": optimiser, "schedule": schedule, "means": means})
    for step in work.steps(recipe.steps):
        batch = _batch(motions, recipe, step)
        latent = model.encoder(batch.transpose(1, 2)).transpose(1, 2)
        flat = latent.reshape(-1, config.code_width)
        if step == 0:
            means.begin(flat.detach())
        codes = model.quantizer.nearest(flat.detach())
        chosen = model.quantizer.codebook[codes].reshape(latent.shape)
        commitment = functional.mse_loss(latent, chosen)
        decoded = model.decoder((latent + (chosen - latent).detach()).transpose(1, 2)).transpose(1, 2)
        loss = functional.smooth_l1_loss(decoded, batch) + recipe.commitment * commitment
        loss = loss + recipe.joints_again * functional.smooth_l1_loss(decoded[..., JOINTS], batch[..., JOINTS])
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimiser.step()
        schedule.step()
        means.follow(flat.detach(), codes, step)
        if work.done % REPORT_EVERY == 0:
            work.history.append({"step": work.done, "loss": float(loss.detach()), "codes_used": means.used()})
    return model.eval()


class RunningMeans:
    """Codebook update by exponential moving averages; idle codes are reset to random latents."""

    def __init__(self, book: Codebook, recipe: TokenizerRecipe):
        self.book, self.recipe = book, recipe
        self.total = torch.zeros_like(book.codebook)
        self.count = torch.zeros(len(book.codebook))

    def begin(self, latents: Float[Tensor, "n width"]) -> None:
        """Initialises every code with a random latent vector."""
        self.total = self._sampled(latents, 0)
        self.count = torch.ones(len(self.total))
        self.book.codebook.copy_(self.total)

    def follow(self, latents: Float[Tensor, "n width"], codes: Tensor, step: int) -> None:
        """Updates the moving averages by one step."""
        keep = self.recipe.running
        one_hot = functional.one_hot(codes, len(self.count)).to(latents.dtype)
        self.total = keep * self.total + (1 - keep) * (one_hot.T @ latents)
        self.count = keep * self.count + (1 - keep) * one_hot.sum(0)
        idle = self.count < self.recipe.idle_below * (1 - keep)
        mean = self.total / self.count.clamp_min(1e-9)[:, None]
        fresh = self._sampled(latents, step)
        self.book.codebook.copy_(torch.where(idle[:, None], fresh, mean))
        self.total = torch.where(idle[:, None], fresh, self.total)
        self.count = torch.where(idle, torch.ones_like(self.count), self.count)

    def used(self) -> int:
        """Number of codes in use."""
        return int((self.count > self.recipe.idle_below).sum())

    def state_dict(self) -> dict[str, Tensor]:
        """State to save."""
        return {"total": self.total, "count": self.count}

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Restores a state of `state_dict`."""
        self.total, self.count = state["total"], state["count"]

    def _sampled(self, latents: Float[Tensor, "n width"], step: int) -> Float[Tensor, "code width"]:
        rng = stream(self.recipe.seed, "motion tokenizer", "codes", step)
        chosen = torch.from_numpy(rng.integers(len(latents), size=len(self.count)))
        noise = torch.from_numpy(rng.normal(0, 0.01, (len(self.count), latents.shape[1])).astype(np.float32))
        return latents[chosen] + noise


def _batch(motions: list[np.ndarray], recipe: TokenizerRecipe, step: int) -> Float[Tensor, "batch frame feature"]:
    rng = stream(recipe.seed, "motion tokenizer", "batch", step)
    long = [motion for motion in motions if len(motion) >= recipe.frames]
    pieces = []
    for k in rng.integers(len(long), size=recipe.batch):
        first = int(rng.integers(len(long[k]) - recipe.frames + 1))
        pieces.append(long[k][first : first + recipe.frames])
    return torch.from_numpy(np.stack(pieces).astype(np.float32))
