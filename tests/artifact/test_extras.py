"""Each feature that needs more than the dependencies says which extra has it, before anything is on the disk."""

import json
import re
import shlex
import shutil
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from mmweaver.core.optional_packages import EXTRAS
from tests.artifact.artifact import ROOT, Installed, modules_of_environment, needed_distributions
from tests.scene.test_scan_folders import stray

RUNNER = Path(__file__).parent / "run_refused.py"
PHOTO = "--rgb rgb.png --depth depth.png --camera camera.json --text 'a person walks' --out out/"
# a command, and the extra that it needs; made/ is a result folder, stray/ a scan of a telephone
FEATURES = (
    ("generate --rgb rgb.png --depth auto --text 'a person walks' --out out/", "pretrained"),
    (f"generate --classes some/model {PHOTO}", "pretrained"),
    ("generate --demo --motion-model small --motion-set for=all --text 'a person waves' --out out/", "pretrained"),
    ("generate --demo --motion-model some/model --motion-set for=all --text 'she waves' --out out/", "pretrained"),
    ("generate --demo --weights some/model --out out/", "weaver"),
    ("generate --room room.glb --text 'a person walks' --out out/", "mesh"),
    ("generate --room room.bag --text 'a person walks' --out out/", "capture"),
    ("generate --room stray/ --text 'a person walks' --out out/", "phone"),
    ("generate --rgb photo.heic --depth depth.png --text 'a person walks' --out out/", "phone"),
    ("dataset out/ --rooms office --layouts 1 --sequences 1", "dataset"),
    ("dataset out/ --rooms office --layouts 1 --sequences 1 --workers 2", "dataset"),
    ("dataset out/ --rooms office --layouts 1 --sequences 1 --ray-address local", "cluster"),
    ("dataset out/ --room . --activities activities.toml --per-class 2", "dataset"),
    ("dataset out/ --from-results results/", "dataset"),
    ("train weaver --data data/ --out out/", "dataset"),
    ("train pose TASK.toml --out out/ --tensorboard", "training"),
    ("recognise train TASK.toml --out out/", "evaluate"),
    ("completion bash", "completion"),
    ("studio --port 0 --no-browser", "studio"),
    *((f"export made/ --to {kind} --out out/", "export") for kind in ("zarr", "netcdf", "ros2", "mcap", "mp4", "webm")),
    ("export made/ --to mp4 --out out.mp4", "export"),
    ("export made/ --to rerun --out out/", "rerun"),
    ("python 'from mmweaver.io.conversions import to_dataset; to_dataset(None, None, (), None, {})'", "xarray"),
    ("python 'from mmweaver.viz.notebook import player_widget; player_widget(None, None)'", "notebook"),
    ("python 'from mmweaver.models.hub import push_to_hub; push_to_hub(None, None)'", "weaver"),
)  # fmt: skip
NOT_IN_AN_EXTRA = {"liblzfse"}  # has no wheels; the message says what to install


@pytest.fixture(scope="module")
def place(carried_out: tuple[Path, dict[str, str]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what the commands read."""
    place, room = tmp_path_factory.mktemp("refused"), carried_out[0] / "room"
    for name in ("rgb.png", "depth.png", "camera.json", "activities.toml", "TASK.toml", "profile.cfg"):
        shutil.copyfile(room / name, place / name)
    shutil.copytree(room / "walk", place / "made")
    shutil.copytree(room / "walk", place / "results" / "one")
    shutil.copytree(room / "data", place / "data")
    (place / "stray").mkdir()
    stray(place / "stray")
    (place / "texts.txt").write_text("a person walks\na person waves\n")
    (place / "photo.heic").write_bytes(b"\0\0\0\x18ftypheic" + bytes(32))
    for name in ("room.glb", "room.bag", "result.rrd"):
        (place / name).write_bytes(b"?")
    return place


def test_a_missing_extra_is_named_in_one_line_and_nothing_is_left(installed: Installed, place: Path):
    given = json.dumps([shlex.split(words) for words, _ in FEATURES])
    done = installed.run([sys.executable, "-P", RUNNER], place, extras=[], given=given)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout.splitlines()[-1])
    wrong = []
    for (words, extra), (status, said, left) in zip(FEATURES, found, strict=True):
        named = [re.findall(r"mmweaver\[(\w+)\]", line) for line in said.splitlines()]
        if status != 2 or named != [[extra]] or left:
            wrong.append((words, status, said, left))
    assert not wrong


def test_extras_are_those_of_the_package():
    """Each extra that a message names exists and has the package; what is installed of it has the module."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    known = modules_of_environment()
    for extra, modules in EXTRAS.items():
        packages = _packages(project["optional-dependencies"], extra)
        for module, package in modules.items():
            assert canonicalize_name(package) in packages, f"{package} is not in extra {extra}"
            owners = {canonicalize_name(name) for name in known.get(module, [])}
            try:
                distribution(package)
            except PackageNotFoundError:
                continue
            assert canonicalize_name(package) in owners, f"{module} is not of {package}"


def test_every_extra_that_is_written_somewhere_exists():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pages = [ROOT / "README.md", *ROOT.glob("docs/*.md"), *(ROOT / "src").rglob("*.py")]
    for page in pages:
        for group in re.findall(r"mmweaver\[(\w+(?:,\w+)*)\]", page.read_text(encoding="utf-8")):
            assert set(group.split(",")) <= set(project["optional-dependencies"]), f"{page.name}: [{group}]"


def test_every_package_that_the_code_imports_is_a_dependency_or_in_an_extra(installed: Installed):
    """Of a package in an extra its own dependencies may be imported, too."""
    known, own = modules_of_environment(), installed.distribution
    needed = needed_distributions(own, EXTRAS)
    optional = {module for modules in EXTRAS.values() for module in modules} | NOT_IN_AN_EXTRA
    for file in sorted((installed.site / "mmweaver").rglob("*.py")):
        for module in _imported(file) - optional - sys.stdlib_module_names - {"mmweaver"}:
            owners = {canonicalize_name(name) for name in known.get(module, [])}
            assert owners & needed, f"{file.relative_to(installed.site)} imports {module}"


def _packages(extras: dict[str, list[str]], extra: str) -> set[str]:
    """The packages of an extra, those of extras that it names included."""
    found: set[str] = set()
    for one in map(Requirement, extras[extra]):
        found |= {canonicalize_name(one.name)}.union(*(_packages(extras, inner) for inner in one.extras))
    return found


def _imported(file: Path) -> set[str]:
    """The first words of all modules that a file imports."""
    code = re.sub(r'"""[\s\S]*?"""', "", file.read_text(encoding="utf-8"))
    return set(re.findall(r"^\s*(?:from|import) (\w+)", code, re.MULTILINE))
