"""An interrupted training ends with the same weights as an uninterrupted one."""

from pathlib import Path

import pytest
import torch

from mmweaver.core.errors import InputError
from mmweaver.training.trainer import Resumable


def run(file: Path | None, steps: int) -> tuple[torch.nn.Module, Resumable]:
    torch.manual_seed(0)
    model = torch.nn.Linear(3, 1)
    optimiser = torch.optim.Adam(model.parameters(), lr=0.1)
    work = Resumable(file, {"model": model, "optimiser": optimiser})
    for step in work.steps(steps):
        torch.manual_seed(step)
        loss = (model(torch.randn(8, 3)) - 1).square().mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        if step % 50 == 0:
            work.history.append({"step": step, "loss": float(loss.detach())})
    return model, work


def test_a_resumed_run_equals_an_uninterrupted_one(tmp_path: Path):
    whole, _ = run(None, 120)
    run(tmp_path / "state.pt", 70)
    resumed, work = run(tmp_path / "state.pt", 120)
    assert torch.equal(whole.weight, resumed.weight)
    assert [row["step"] for row in work.history] == [0, 50, 100]
    finished, _ = run(tmp_path / "state.pt", 120)
    assert torch.equal(whole.weight, finished.weight)


def test_it_resumes_with_its_number_of_threads(tmp_path: Path, caplog: pytest.LogCaptureFixture):
    run(tmp_path / "state.pt", 1)
    state = torch.load(tmp_path / "state.pt", weights_only=True)
    assert state["threads"] == torch.get_num_threads() == 1
    torch.save(state | {"threads": 2}, tmp_path / "state.pt")
    try:
        run(tmp_path / "state.pt", 2)
        assert torch.get_num_threads() == 2
    finally:
        torch.set_num_threads(1)
    assert "resumes with 2" in caplog.text
    del state["threads"]  # as an earlier version wrote it
    torch.save(state, tmp_path / "state.pt")
    run(tmp_path / "state.pt", 2)
    assert torch.get_num_threads() == 1


def test_a_state_of_something_else_is_refused(tmp_path: Path):
    (tmp_path / "state.pt").write_text("weights")
    with pytest.raises(InputError, match="delete it"):
        run(tmp_path / "state.pt", 3)
