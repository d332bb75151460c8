"""Tiny models with random weights, saved as published ones are."""

from pathlib import Path

import pytest

ADE = {0: "wall", 1: "floor, flooring", 2: "sofa, couch, lounge", 3: "windowpane, window"}


def _saved(model, processor, folder: Path) -> str:
    model.save_pretrained(folder)
    processor.save_pretrained(folder)
    return str(folder)


def _transformers():
    transformers = pytest.importorskip("transformers")
    torch = pytest.importorskip("torch")
    torch.manual_seed(0)
    transformers.utils.logging.set_verbosity_error()
    transformers.utils.logging.disable_progress_bar()
    return transformers


def segformer(folder: Path, labels: dict[int, str] = ADE) -> str:
    t = _transformers()
    config = t.SegformerConfig(
        num_encoder_blocks=2, depths=[1, 1], sr_ratios=[2, 1], hidden_sizes=[8, 16], patch_sizes=[7, 3],
        strides=[4, 2], num_attention_heads=[1, 2], mlp_ratios=[2, 2], decoder_hidden_size=16, id2label=labels,
        label2id={label: index for index, label in labels.items()},
    )  # fmt: skip
    processor = t.SegformerImageProcessorPil(size={"height": 64, "width": 64})
    return _saved(t.SegformerForSemanticSegmentation(config), processor, folder)


def _swin(t):
    return t.SwinConfig(
        image_size=64, embed_dim=8, depths=[1, 1, 1, 1], num_heads=[1, 1, 1, 1], window_size=2,
        out_features=["stage1", "stage2", "stage3", "stage4"],
    )  # fmt: skip


def mask2former(folder: Path) -> str:
    t = _transformers()
    config = t.Mask2FormerConfig(
        backbone_config=_swin(t), feature_size=32, mask_feature_size=32, hidden_dim=32, encoder_feedforward_dim=16,
        encoder_layers=1, decoder_layers=2, num_attention_heads=2, dim_feedforward=16, num_queries=5, id2label=ADE,
    )  # fmt: skip
    processor = t.Mask2FormerImageProcessorPil(size={"height": 64, "width": 64})
    return _saved(t.Mask2FormerForUniversalSegmentation(config), processor, folder)


def sam(folder: Path) -> str:
    t = _transformers()
    config = t.SamConfig(
        vision_config={
            "hidden_size": 16, "num_hidden_layers": 1, "num_attention_heads": 2, "mlp_dim": 16, "image_size": 64,
            "patch_size": 16, "output_channels": 32, "window_size": 2, "global_attn_indexes": [0], "num_pos_feats": 16,
        },
        prompt_encoder_config={"hidden_size": 32, "image_size": 64, "patch_size": 16, "mask_input_channels": 4},
        mask_decoder_config={
            "hidden_size": 32, "num_hidden_layers": 1, "num_attention_heads": 2, "mlp_dim": 16,
            "iou_head_hidden_dim": 16, "iou_head_depth": 2,
        },
    )  # fmt: skip
    processor = t.SamImageProcessorPil(
        size={"longest_edge": 64}, pad_size={"height": 64, "width": 64}, mask_size={"longest_edge": 16},
        mask_pad_size={"height": 16, "width": 16},
    )  # fmt: skip
    return _saved(t.SamModel(config), processor, folder)


def depth_anything(folder: Path, kind: str = "metric") -> str:
    t = _transformers()
    backbone = t.Dinov2Config(
        image_size=28, patch_size=14, hidden_size=16, num_hidden_layers=4, num_attention_heads=2,
        intermediate_size=16, out_features=["stage1", "stage2", "stage3", "stage4"], reshape_hidden_states=False,
        apply_layernorm=True,
    )  # fmt: skip
    config = t.DepthAnythingConfig(
        backbone_config=backbone, reassemble_hidden_size=16, patch_size=14, neck_hidden_sizes=[8, 8, 8, 8],
        fusion_hidden_size=8, head_hidden_size=8, depth_estimation_type=kind, max_depth=20,
    )  # fmt: skip
    processor = t.DPTImageProcessorPil(size={"height": 28, "width": 28}, do_pad=False)
    return _saved(t.DepthAnythingForDepthEstimation(config), processor, folder)
