"""Mixed precision keeps out of geometry."""

import torch

from mmweaver.models.precision import full_precision


def test_products_inside_are_exact_and_bf16_comes_in_as_float32():
    a, b = torch.randn(4, 4), torch.randn(4, 4)

    @full_precision
    def product(x, y, name):
        assert name == "kept"
        return x @ y

    with torch.autocast("cpu", torch.bfloat16):
        assert (a @ b).dtype == torch.bfloat16
        assert torch.allclose(product(a, b, "kept"), a.double().matmul(b.double()).float(), atol=1e-6)
        assert product(a.bfloat16(), b, "kept").dtype == torch.float32
