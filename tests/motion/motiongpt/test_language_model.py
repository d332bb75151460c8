"""The language model: the published sizes, motion tokens behind the words, lengths and seeds."""

from functools import cache

import torch
from motiongpt_files import SENTENCES, TINY, tiny

from mmweaver.motion.motiongpt.language_model import PUBLISHED_T5, add_motion_tokens, build_t5, sample_codes
from tests.motion.motiongpt_weights import train_words

# flan-t5-base with 32,100 words and 515 motion tokens.
PUBLISHED = {
    "shared.weight": (32615, 768),
    "lm_head.weight": (32615, 768),
    "encoder.block.0.layer.0.SelfAttention.q.weight": (768, 768),
    "encoder.block.0.layer.0.SelfAttention.relative_attention_bias.weight": (32, 12),
    "encoder.block.11.layer.1.DenseReluDense.wi_1.weight": (2048, 768),
    "encoder.block.11.layer.1.DenseReluDense.wo.weight": (768, 2048),
    "decoder.block.11.layer.1.EncDecAttention.o.weight": (768, 768),
    "decoder.block.11.layer.2.DenseReluDense.wi_0.weight": (2048, 768),
    "decoder.final_layer_norm.weight": (768,),
}


def test_published_names_shapes_and_size():
    with torch.device("meta"):
        model = build_t5(PUBLISHED_T5)
    state = model.state_dict()
    for name, shape in PUBLISHED.items():
        assert tuple(state[name].shape) == shape
    blocks = {name.split(".block.")[0] + name.split(".block.")[1].split(".")[0] for name in state if ".block." in name}
    assert len(blocks) == 24
    feed_forward, norm = 3 * 768 * 2048, 768
    encoder, decoder = 4 * 768**2 + feed_forward + 2 * norm, 8 * 768**2 + feed_forward + 3 * norm
    beside = 2 * 32 * 12 + 2 * norm  # relative places, last norms
    words = 2 * 32615 * 768  # those that come in and those that go out do not share a matrix
    assert sum(p.numel() for p in model.parameters()) == 12 * (encoder + decoder) + beside + words


def test_motion_tokens_stand_in_their_order_behind_the_words():
    words = train_words(SENTENCES)
    plain = len(words)
    first = add_motion_tokens(words, 512)
    assert first == plain
    assert len(words) == plain + 515
    assert words.convert_tokens_to_ids("<motion_id_513>") == first + 513
    assert words("<motion_id_512><motion_id_7>").input_ids[:2] == [first + 512, first + 7]


@cache
def language_model():
    return tiny()[1]


def codes(seed: int = 0, tokens: int | None = 9, **more) -> list[int]:
    language = language_model()
    first = language.config.vocab_size - TINY.codes - 3
    return sample_codes(
        language, torch.tensor([[3, 4, 1]]), first_motion_id=first, codes=TINY.codes, tokens=tokens, most_tokens=49,
        seed=seed, **more,
    )  # fmt: skip


def test_exactly_the_length_that_is_asked_for():
    for tokens in (1, 9, 49):
        said = codes(tokens=tokens)
        assert len(said) == tokens
        assert all(0 <= code < TINY.codes for code in said)


def test_the_same_seed_says_the_same_and_leaves_the_global_stream_alone():
    language_model()
    torch.manual_seed(5)
    one = codes(3)
    after = torch.rand(1)
    torch.manual_seed(5)
    assert torch.equal(after, torch.rand(1))
    assert one == codes(3)
    assert one != codes(4)


def test_without_a_length_only_codes_are_kept():
    for seed in range(5):
        assert all(0 <= code < TINY.codes for code in codes(seed, tokens=None))
