"""Builds what users install, installs it into a folder, and runs child processes that see that folder alone."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution, packages_distributions
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
BUILT_FROM = ("pyproject.toml", "README.md", "LICENSE", "src")
HOOK = Path(__file__).parent / "sitecustomize.txt"
LOADED_FROM, ABSENT = "MMWEAVER_LOADED_FROM", "MMWEAVER_ABSENT"  # environment variables that the hook reads


def source_files(*places: str) -> list[str]:
    """Files below some places, as git knows them, new ones too unless it ignores them; without git all but caches."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *places]
    try:
        listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")
        names = {name for name in listed if name and (ROOT / name).is_file()}
    except (OSError, subprocess.CalledProcessError):
        names = set()
    if not names:  # an archive of the sources
        found = [path for place in places for path in ((ROOT / place), *(ROOT / place).rglob("*"))]
        kept = [path for path in found if path.is_file() and path.suffix != ".pyc" and "egg-info" not in str(path)]
        names = {path.relative_to(ROOT).as_posix() for path in kept}
    return sorted(names)


def copy_sources(to: Path) -> Path:
    """A copy of what is built from, free of what earlier builds left."""
    for name in source_files(*BUILT_FROM):
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, to / name)
    return to


def build(tree: Path, kind: str, out: Path) -> Path:
    """The "wheel" or "sdist" of a tree, by the hook that pip and build call."""
    out.mkdir(exist_ok=True)
    code = f"from setuptools import build_meta; build_meta.build_{kind}({str(out)!r})"
    done = subprocess.run([sys.executable, "-c", code], cwd=tree, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    (built,) = out.iterdir()
    return built


@dataclass(frozen=True)
class Installed:
    """A wheel that is installed into a folder of its own; the environment has the packages that it depends on."""

    wheel: Path
    site: Path

    @property
    def script(self) -> Path:
        """The command `mmweaver` as pip made it."""
        (found,) = [*self.site.glob("bin/mmweaver*"), *self.site.glob("Scripts/mmweaver*")]
        return found

    @property
    def distribution(self) -> Distribution:
        """What the wheel says of itself."""
        (place,) = self.site.glob("*.dist-info")
        return Distribution.at(place)

    def run(
        self, command: Sequence[str | Path], place: Path, *, extras: Iterable[str] | None = None,
        given: str | None = None,
    ) -> subprocess.CompletedProcess[str]:  # fmt: skip
        """Runs a command in a folder. It sees the installed package; with `extras` no package but those of its
        dependencies and of these extras."""
        loaded = self.site / "loaded.txt"
        loaded.unlink(missing_ok=True)
        environment = {**os.environ, "PYTHONPATH": str(self.site), LOADED_FROM: str(loaded), ABSENT: "[]"}
        environment["PATH"] = os.pathsep.join((str(self.script.parent), os.environ.get("PATH", "")))
        if extras is not None:
            environment[ABSENT] = json.dumps(sorted(absent_modules(self.distribution, extras)))
        done = subprocess.run(
            [str(word) for word in command], cwd=place, env=environment, input=given, capture_output=True, text=True,
            encoding="utf-8", check=False,
        )  # fmt: skip
        if loaded.is_file():
            assert Path(loaded.read_text(encoding="utf-8")).is_relative_to(self.site)
        return done


def install(wheel: Path, site: Path) -> Installed:
    """Installs a wheel, without its dependencies, into a folder."""
    words = ["install", "--no-deps", "--no-compile", "--no-index", "--quiet", "--target", str(site), str(wheel)]
    subprocess.run([sys.executable, "-m", "pip", "--disable-pip-version-check", *words], check=True)
    shutil.copyfile(HOOK, site / "sitecustomize.py")
    return Installed(wheel, site)


def needed_distributions(own: Distribution, extras: Iterable[str]) -> set[str]:
    """Names of all distributions that a distribution needs with some extras, as far as they are installed."""
    needed: set[str] = set()
    asked = [(own, extra) for extra in ("", *extras)]
    seen: set[tuple[str, str]] = set()
    while asked:
        of, extra = asked.pop()
        name = canonicalize_name(of.metadata["Name"])
        if (name, extra) in seen:
            continue
        seen.add((name, extra))
        needed.add(name)
        for words in of.requires or ():
            one = Requirement(words)
            if one.marker is not None and not one.marker.evaluate({"extra": extra}):
                continue
            try:
                found = own if canonicalize_name(one.name) == canonicalize_name(own.metadata["Name"]) else None
                found = found or distribution(one.name)
            except PackageNotFoundError:
                continue
            asked += [(found, wanted) for wanted in ("", *one.extras)]
    return needed


@cache
def modules_of_environment() -> dict[str, list[str]]:
    """The distributions of each module that can be imported here."""
    return dict(packages_distributions())


def absent_modules(own: Distribution, extras: Iterable[str]) -> set[str]:
    """Modules of the environment that an installation with some extras alone would lack."""
    needed = needed_distributions(own, extras)
    return {
        module
        for module, names in modules_of_environment().items()
        if not needed & {canonicalize_name(name) for name in names}
    }
