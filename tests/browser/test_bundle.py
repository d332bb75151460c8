"""The committed bundle is what its sources give."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
BUNDLE = Path("src/mmweaver/viz/page/mmweaver.js")


def test_the_bundle_is_current(tmp_path: Path):
    node, modules = shutil.which("node"), REPOSITORY / "web" / "node_modules"
    if node is None or not modules.is_dir():
        pytest.skip("no Node or web/node_modules here; `make studio` installs and rebuilds")
    shutil.copytree(REPOSITORY / "web", tmp_path / "web", ignore=shutil.ignore_patterns("node_modules"))
    (tmp_path / "web" / "node_modules").symlink_to(modules)
    (tmp_path / BUNDLE.parent).mkdir(parents=True)
    subprocess.run([node, "build.mjs"], cwd=tmp_path / "web", check=True, env={**os.environ, "NODE_OPTIONS": ""})
    assert (tmp_path / BUNDLE).read_bytes() == (REPOSITORY / BUNDLE).read_bytes(), "run `make studio` and commit it"
