"""A small tokenizer learns a few waves, and an interrupted training ends the same."""

from pathlib import Path

import numpy as np
import pytest
import torch

from mmweaver.motion.motiongpt.tokenizer import MotionTokenizer, TokenizerConfig
from studies.motion.motion_tokenizer import TokenizerRecipe, train_tokenizer

TINY = TokenizerConfig(features=205, codes=24, code_width=8, width=16)  # 205: joints' ways are columns 193 on


def waves() -> list[np.ndarray]:
    time = np.arange(64)[:, None] / 20
    return [np.sin(2 * np.pi * (0.5 + 0.3 * k) * time + np.arange(205) / 30) for k in range(6)]


def error(model: MotionTokenizer) -> float:
    batch = torch.from_numpy(np.stack(waves()).astype(np.float32))
    with torch.inference_mode():
        return float((model.decode(model.encode(batch)) - batch).square().mean() / batch.square().mean())


@pytest.mark.slow  # test_an_interruption_changes_nothing trains it, too
def test_it_learns_and_uses_its_codes(tmp_path: Path):
    recipe = TokenizerRecipe(steps=150, batch=8, frames=32, learning_rate=2e-3)
    trained = train_tokenizer(waves(), TINY, recipe, tmp_path / "state.pt")
    assert error(trained) < 0.35
    assert error(train_tokenizer(waves(), TINY, TokenizerRecipe(steps=0, batch=8, frames=32))) > 0.9
    with torch.inference_mode():
        codes = trained.encode(torch.from_numpy(np.stack(waves()).astype(np.float32)))
    assert len(codes.unique()) > 8


def test_an_interruption_changes_nothing(tmp_path: Path):
    recipe = TokenizerRecipe(steps=20, batch=4, frames=32)
    whole = train_tokenizer(waves(), TINY, recipe)
    state = tmp_path / "state.pt"
    interrupted = TokenizerRecipe(steps=20, batch=4, frames=32)
    _stop_after(interrupted, 8, state)
    resumed = train_tokenizer(waves(), TINY, recipe, state)
    for one, other in zip(whole.state_dict().values(), resumed.state_dict().values(), strict=True):
        torch.testing.assert_close(one, other, rtol=0, atol=0)


def _stop_after(recipe: TokenizerRecipe, steps: int, state: Path) -> None:
    """The same recipe, interrupted, with the usual saves."""
    from mmweaver.training import trainer

    every, trainer.SAVE_EVERY_S = trainer.SAVE_EVERY_S, 0.0
    original = trainer.Resumable.steps

    def cut(self: trainer.Resumable, most: int):
        for done, step in enumerate(original(self, most)):
            if done == steps:
                return
            yield step

    trainer.Resumable.steps = cut  # type: ignore[method-assign]
    try:
        train_tokenizer(waves(), TINY, recipe, state)
    finally:
        trainer.Resumable.steps, trainer.SAVE_EVERY_S = original, every
