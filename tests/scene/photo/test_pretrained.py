"""Folders and names without a model: one line that says what to do."""

import json
import sys
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.scene.photo.estimated_depth import load_pretrained
from tests.scene import models

pytest.importorskip("transformers")


def any_segmenter(transformers, config):
    return transformers.AutoModelForSemanticSegmentation


def error(source: str) -> str:
    with pytest.raises(InputError) as raised:
        load_pretrained(source, "--classes", any_segmenter)
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_missing_models_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_OFFLINE", True)  # read when it was imported
    assert "without config.json" in error(str(tmp_path))
    assert "is not a folder" in error(str(tmp_path / "none"))
    assert "is not a folder" in error("./none")
    assert "hf download" in error("nobody/no-such-model")


def test_damaged_folders_are_refused(tmp_path: Path):
    folder = tmp_path / "model"
    models.segformer(folder)
    weights = folder / "model.safetensors"
    whole = weights.read_bytes()
    weights.write_bytes(whole[: len(whole) // 2])
    assert "cannot be loaded" in error(str(folder))
    weights.unlink()
    (folder / "pytorch_model.bin").write_bytes(b"a pickle of something else")
    assert "model.safetensors" in error(str(folder))
    weights.write_bytes(whole)
    (folder / "preprocessor_config.json").unlink()
    assert "preprocessor_config.json" in error(str(folder))
    (folder / "config.json").write_text(json.dumps({"model_type": "gobbledygook"}))
    assert "cannot be loaded" in error(str(folder))
    (folder / "config.json").write_text("{")
    assert "cannot be loaded" in error(str(folder))


def test_without_transformers(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "transformers", None)
    assert "mmweaver[pretrained]" in error("any/model")
