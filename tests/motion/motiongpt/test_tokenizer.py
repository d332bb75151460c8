"""The motion tokenizer: the published keys and shapes, four frames a token, nearest codes."""

import torch

from mmweaver.motion.motiongpt.tokenizer import Codebook, MotionTokenizer, TokenizerConfig

# Shapes of the published tokenizer, from the description of its architecture; not from our own code.
PUBLISHED = {
    "encoder.model.0.weight": (512, 263, 3),
    "encoder.model.2.0.weight": (512, 512, 4),
    "encoder.model.2.1.model.0.conv1.weight": (512, 512, 3),
    "encoder.model.2.1.model.2.conv2.weight": (512, 512, 1),
    "encoder.model.3.0.bias": (512,),
    "encoder.model.4.weight": (512, 512, 3),
    "decoder.model.0.weight": (512, 512, 3),
    "decoder.model.2.0.model.1.conv1.weight": (512, 512, 3),
    "decoder.model.2.2.weight": (512, 512, 3),
    "decoder.model.3.2.bias": (512,),
    "decoder.model.4.weight": (512, 512, 3),
    "decoder.model.6.weight": (263, 512, 3),
    "quantizer.codebook": (512, 512),
}


def test_published_names_and_shapes():
    with torch.device("meta"):
        state = MotionTokenizer(TokenizerConfig()).state_dict()
    for name, shape in PUBLISHED.items():
        assert tuple(state[name].shape) == shape
    # weights and biases: 2 convolutions and 2 x (1 + 3 x 2) in the encoder, 3 and 2 x (1 + 3 x 2) in the decoder
    assert len(state) == 2 * (2 + 14) + 2 * (3 + 14) + 1


def test_four_frames_a_token():
    model = MotionTokenizer(TokenizerConfig(width=8, code_width=8, codes=4))
    model.quantizer.codebook.normal_()
    codes = model.encode(torch.randn(2, 43, 263))
    assert codes.shape == (2, 10)
    assert model.decode(codes).shape == (2, 40, 263)


def test_the_nearest_code_is_taken():
    book = Codebook(TokenizerConfig(codes=64, code_width=5))
    book.codebook.normal_()
    x = torch.randn(100, 5)
    assert torch.equal(book.nearest(x), torch.cdist(x, book.codebook).argmin(dim=1))
