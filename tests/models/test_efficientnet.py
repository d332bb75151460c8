"""The front of EfficientNet-B0 against transformers' model of the same name."""

import pytest
import torch

from mmweaver.models.environment_encoder import Stem, make_blocks

transformers = pytest.importorskip("transformers")


@pytest.mark.parametrize("training", [False, True])
def test_it_computes_what_transformers_computes(training: bool) -> None:
    torch.manual_seed(0)
    config = transformers.EfficientNetConfig(
        width_coefficient=1.0, depth_coefficient=1.0, hidden_dim=1280, num_channels=5, drop_connect_rate=0.0
    )
    theirs = transformers.EfficientNetModel(config).train(training)
    for module in theirs.modules():  # theirs begin so small that nothing would be left to compare
        if isinstance(module, torch.nn.Conv2d):
            torch.nn.init.kaiming_normal_(module.weight)
        elif isinstance(module, torch.nn.BatchNorm2d):
            torch.nn.init.uniform_(module.weight, 0.5, 1.5)
            torch.nn.init.uniform_(module.running_var, 0.5, 1.5)
    ours = torch.nn.ModuleDict({"stem": Stem(5), "blocks": torch.nn.ModuleList(make_blocks(16))})
    state = {name: values for name, values in theirs.state_dict().items() if not name.startswith("encoder.top")}
    state = {
        name.replace("embeddings.", "stem.").replace("encoder.blocks", "blocks"): values
        for name, values in state.items()
    }
    ours.load_state_dict(state)
    for module in ours.modules():
        if isinstance(module, torch.nn.Dropout):
            module.p = 0.0
    ours.train(training)
    image = torch.randn(2, 5, 96, 128)
    with torch.no_grad():
        wanted = theirs.embeddings(image)
        for block in theirs.encoder.blocks:
            wanted = block(wanted)
        got = ours["stem"](image)
        for block in ours["blocks"]:
            got = block(got)
    assert wanted.std() > 1e-2
    torch.testing.assert_close(got, wanted, rtol=1e-4, atol=1e-5)


def test_later_blocks_drop_more_and_only_where_they_add() -> None:
    blocks = make_blocks(16)
    rates = [block.dropout.p for block in blocks]
    assert rates[0] == 0.0
    assert rates == sorted(rates)
    assert rates[-1] == pytest.approx(0.2 * 15 / 16)
    assert [block.is_residual for block in blocks].count(True) == 9
