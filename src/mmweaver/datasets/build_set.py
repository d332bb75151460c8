"""Builds a labelled set: paired draws, one sequence after another, then the store with its splits and leak report.

Finished sequences are kept in `parts/`, so a run can be stopped at any time and resumed with identical results.
"""

import json
import shutil
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file, claimed_folder, create_once, staged_folder
from mmweaver.core.boards import find_board
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.output_checks import check_output_folder, is_empty
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import parse_json, read_json, read_toml
from mmweaver.core.seeding import stream
from mmweaver.core.staging import remove
from mmweaver.datasets.activity_store import (
    ACTIVITIES_FILE,
    IQ_KINDS,
    LEAKS_FILE,
    SCHEMA_VERSION,
    SET_FILE,
    SPLIT_KEYS,
    SPLITS,
    STORE,
    bytes_of_signals,
    write_set,
)
from mmweaver.datasets.confounders import circumstances, leak_report
from mmweaver.datasets.data_card import write_set_card
from mmweaver.datasets.dataset_cost import BENCHMARK_FRAMES, DatasetCost
from mmweaver.datasets.paired_sampling import (
    Draw,
    GivenPlacing,
    PlannedSequence,
    Trials,
    differing_descriptions,
    done_by_anybody,
    paired_draws,
    places_of,
    shuffled,
    unpaired_reasons,
)
from mmweaver.datasets.signals_on_demand import SetGeometry, moving_power_db, storable
from mmweaver.datasets.zarr_arrays import packed_iq
from mmweaver.io.npz_files import read_npz, write_npz
from mmweaver.motion.register_activity import activities_of
from mmweaver.signal.features import point_table
from mmweaver.weaver.composition import compose_request
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Room
from mmweaver.weaver.parsed_request import ParsedRequest

PARTS = "parts"
SHARES = (0.7, 0.15, 0.15)  # share of groups in train, validation and test
DEFAULT_SECONDS = 3.0
SET_FILES = 70  # and another for each 32 MB of signals
# CPU seconds per 20 frames by method, including composition; measured on 300 sequences of ten activities
SEQUENCE_S = {"weaver": 0.12, "physics": 0.4}
ON_DEMAND_BYTES = 75_000.0  # per 30 frames without signals
BYTES = {"float16": 4.0, "float32": 8.0}  # per complex value

Activities = dict[str, tuple[str, ...]]  # sentences by label, in the order of label numbers


def read_activities(file: Path) -> Activities:
    """Reads a TOML file of labels and parses all their sentences.

    Args:
        file: The file.

    Returns:
        Sentences by label.

    Raises:
        InputError: If the file is malformed, or a sentence is not understood.
    """
    return activities_of(read_toml(file), file)


@dataclass(frozen=True, kw_only=True)
class SetOptions:
    """Options of a set; together with rooms and radar they determine it bit for bit.

    Raises:
        InputError: If an option is out of range.
    """

    each: int = 20  # sequences per label
    seconds: float = DEFAULT_SECONDS
    subjects: int = 10
    places: int = 12  # per room
    split_by: str = "subject"
    seed: int = 0
    iq: str = "float16"  # one of IQ_KINDS
    board: str = "typical"  # of all sequences; sampled with the seed
    strict: bool = False  # whether places are refused where something is not done as a sentence says

    def __post_init__(self) -> None:
        for name, most in (("each", 100_000), ("subjects", 10_000), ("places", 1000)):
            if not 1 <= getattr(self, name) <= most:
                raise InputError(f"{name} must be 1 to {most}, not {getattr(self, name)}")
        if self.split_by not in SPLIT_KEYS:
            raise InputError(f"splits are by {', '.join(SPLIT_KEYS)}, not {self.split_by!r}")
        if self.iq not in IQ_KINDS:
            raise InputError(f"signals are stored as {', '.join(IQ_KINDS)}, not {self.iq!r}")
        if self.seed < 0:
            raise InputError(f"the seed must be 0 or above, not {self.seed}")


class SetBuilder:
    """Builds one set: `plan` determines its content, `make` generates what is missing."""

    def __init__(
        self,
        out: Path,
        activities: Activities,
        rooms: Sequence[Room],
        weaver: Weaver,
        options: SetOptions,
        *,
        command: str,
        activities_text: str,
        given: GivenPlacing | None = None,
    ):
        """Prepares a set; nothing is written yet.

        Args:
            out: Folder of the set.
            activities: Sentences by label.
            rooms: Rooms, used in turn.
            weaver: Generator of the signals, with radar and method.
            options: Options.
            command: Command line, stored in set.json.
            activities_text: Content of activities.toml.
            given: Placement that the user fixed for all sequences. Default: sampled.

        Raises:
            InputError: If the board is unknown, or signals on demand are impossible.
        """
        self.out, self.activities, self.rooms, self.weaver, self.options = out, activities, list(rooms), weaver, options
        self.command, self.activities_text, self.given = command, activities_text, given
        self.labels = tuple(activities)
        self._board = find_board(options.board, weaver.radar, options.seed)
        if options.iq == "none" and not weaver.is_standard:
            raise InputError(
                "signals are made on demand by the methods as they are installed; leave out weights and"
                " propagation of your own, or store signals (--iq float16)"
            )
        if options.iq == "none" and any(room.background is not None for room in self.rooms):
            raise InputError("signals on demand have no background recording; leave it out, or store signals")

    @cached_property
    def plan(self) -> list[PlannedSequence]:
        """All sequences in the order of the set.

        Raises:
            InputError: If no place in a room serves an activity.
        """
        options, range_m = self.options, self.weaver.radar.range_m
        window_m = float(range_m[0]), float(range_m[-1])
        places = [places_of(room.scene, window_m, options.places, options.seed) for room in self.rooms]
        sequences: list[PlannedSequence] = []
        labels = len(self.labels)
        trials = self._trials.lost
        for draws in paired_draws(places, options.each, options.subjects, options.seed, labels, self._obstacle, trials):
            sequences += [self._sequence(self._placed(draw), label) for label, draw in enumerate(draws)]
        return shuffled(sequences, options.seed)

    def _sequence(self, draw: Draw, label: int) -> PlannedSequence:
        sentences = self.activities[self.labels[label]]
        sentence = (draw.index + label) % len(sentences)
        return PlannedSequence(draw=draw, label=label, sentence=sentence, text=sentences[sentence])

    def _obstacle(self, draw: Draw, label: int) -> str:
        """Why a draw does not serve a label; "" if it does."""
        one = self._sequence(self._placed(draw), label)
        return self._trials.obstacle(draw, label, self.request_of(one), self.rooms[draw.room].scene, one.text)

    @cached_property
    def _trials(self) -> Trials:
        return Trials()

    def _placed(self, draw: Draw) -> Draw:
        return draw if self.given is None else self.given.applied(draw)

    def request_of(self, one: PlannedSequence) -> ParsedRequest:
        """Builds the request that generates one sequence.

        Args:
            one: The planned sequence.

        Returns:
            The request, with place, heading, person and seed of its draw.
        """
        draw = one.draw
        height_m = None if self.given is None else self.given.height_m
        request = self.weaver.request(
            one.text,
            seconds=self.options.seconds,
            seed=draw.seed,
            at=draw.start_m,
            heading_rad=draw.heading_rad,
            subject=draw.subject,
            height_m=height_m,
            board=self._board,
            strict=self.options.strict,
        )
        return done_by_anybody(request) if self.ignored_descriptions else request

    @cached_property
    def ignored_descriptions(self) -> list[str]:
        """Differing descriptions of people in the sentences; they are ignored, since each subject does everything."""
        texts = [text for sentences in self.activities.values() for text in sentences]
        return differing_descriptions(self.weaver.request(text, seconds=self.options.seconds) for text in texts)

    # making ----------------------------------------------------------------------------------------------------------
    @property
    def is_made(self) -> bool:
        """Whether the set is complete."""
        return (self.out / STORE).is_dir()

    @property
    def finished(self) -> int:
        """Number of finished sequences."""
        if self.is_made:
            return len(self.plan)
        return len(list((self.out / PARTS).glob("[0-9]*.npz")))

    def make(self, listener: Callable[[int, int], object] | None = None) -> dict[str, Any]:
        """Generates what is missing.

        Args:
            listener: Called with the number of finished and of all sequences. Default: none.

        Returns:
            The leak report.

        Raises:
            InputError: If the folder contains something else or a set with other settings, or no place serves an
                activity.
        """
        with claimed_folder(self.out):
            self._begin()
            if not self.is_made:
                for number, one in enumerate(self.plan):
                    self._part(number, one)
                    if listener is not None:
                        listener(number + 1, len(self.plan))
                self._assemble()
            remove(self.out / PARTS)
            write_set_card(self.out)
        return read_json(self.out / LEAKS_FILE)

    def check_folder(self) -> None:
        """Checks that the folder is usable; fast, unlike the plan.

        Raises:
            InputError: If it contains something else, or zarr is not installed.
        """
        need("dataset", "a labelled set", "zarr")
        check_output_folder(self.out, overwrite=True, files=[SET_FILE, LEAKS_FILE])
        if self.out.is_dir() and not is_empty(self.out) and not (self.out / SET_FILE).is_file():
            raise InputError(f"{self.out} is not empty and holds no labelled set; choose another folder")

    def _begin(self) -> None:
        """Writes set.json. Raises InputError before anything is written if no place serves an activity."""
        self.check_folder()
        if not (self.out / SET_FILE).is_file():
            _ = self.plan
        text = json.dumps(self._description(), indent=1, ensure_ascii=False) + "\n"
        held = create_once(self.out / SET_FILE, text)
        if held != text and _comparable(held) != _comparable(text):
            raise InputError(f"{self.out} holds a set of other settings; choose another folder or the same settings")

    def _description(self) -> dict[str, Any]:
        return {
            "schema_version": SCHEMA_VERSION,
            "command": self.command,
            "options": {name: value for name, value in asdict(self.options).items() if name != "strict" or value},
            "activities": {label: list(texts) for label, texts in self.activities.items()},
            "rooms": [room.inputs for room in self.rooms],
            **({} if self.given is None else {"given": asdict(self.given)}),
            "method": self.weaver.method_name,
            "radar": parse_json(self.weaver.radar.to_json(), "the radar"),
        }

    def _part(self, number: int, one: PlannedSequence) -> None:
        file = self.out / PARTS / f"{number:06d}.npz"
        if file.is_file():
            return
        request, room = self.request_of(one), self.rooms[one.draw.room]
        people = tuple(replace(each, pose=storable(each.pose)) for each in compose_request(request, room.scene))
        made = self.weaver.carry_out(request, room, people)
        iq, iq_scale = packed_iq(made.cube, self.options.iq)
        power = float(np.mean(np.abs(made.cube.values) ** 2)) * made.cube.scale**2
        arrays = {
            "joints": made.pose.joints_m.astype(np.float32),
            "points": point_table(made.points),
            "point_frame": made.points.frame.astype(np.int32),
            "iq_scale": np.float64(iq_scale),
            "height": np.float64(made.pose.height_m),
            "energy_db": np.float64(10 * np.log10(max(power, 1e-300))),
            "pace": np.float64(np.mean([step.pace for step in made.meta["plan"].steps])),
        }
        if self.options.iq == "none":
            arrays |= {
                "motion": made.motion.joints_m.astype(np.float32),
                "motion_time": made.motion.time_s,
                "girth": np.float64(made.motion.girth),
                "moving_power_db": np.float64(moving_power_db(made.cube)),
            }
        else:
            arrays["iq"] = iq
        with atomic_file(file) as temporary:
            write_npz(temporary, **arrays)

    def cost(self) -> DatasetCost:
        """Estimates the cost of the missing sequences.

        Raises:
            InputError: If no place serves an activity.
        """
        missing, request = len(self.plan) - self.finished, self.request_of(self.plan[0])
        config, frames = request.config, request.frames
        values = frames * config.num_range_bins * config.num_loops * config.num_antennas
        each = ON_DEMAND_BYTES * frames / 30 if self.options.iq == "none" else BYTES[self.options.iq] * values
        seconds = SEQUENCE_S.get(self.weaver.method_name, SEQUENCE_S["weaver"])
        return DatasetCost(
            rooms=len(self.rooms),
            sequences=missing,
            core_s=missing * frames / BENCHMARK_FRAMES * seconds,
            disk_bytes=missing * each,
            files=SET_FILES,
            splits=dict(Counter(self.splits[f"split_{self.options.split_by}"]).most_common()),
        )

    # the store -------------------------------------------------------------------------------------------------------
    def _assemble(self) -> None:
        small = ("joints", "points", "point_frame", "iq_scale", "height", "energy_db", "pace")
        parts = [
            {name: np.asarray(stored[name]) for name in small}
            for stored in (read_npz(self._part_file(number)) for number in range(len(self.plan)))
        ]
        plan, options = self.plan, self.options
        heights = [float(part["height"]) for part in parts]
        columns = {
            "label": [one.label for one in plan],
            "text": [one.text for one in plan],
            "height": heights,
            "subject": [one.draw.subject for one in plan],
            "place": [one.draw.place for one in plan],
            "room": [one.draw.room for one in plan],
            "draw": [one.draw.index for one in plan],
            "heading": [one.draw.heading_rad for one in plan],
            "split": self.splits[f"split_{options.split_by}"],
            **self.splits,
        }
        more = {
            "person": columns["subject"],
            "room": columns["room"],
            "height": heights,
            "tempo": [float(part["pace"]) for part in parts],
            "energy": [float(part["energy_db"]) for part in parts],
        }
        with staged_folder(self.out, overwrite=True) as stage:
            signals = self._geometry(heights) if options.iq == "none" else self._part_arrays("iq")
            arrays = {
                "joints_m": [part["joints"] for part in parts],
                "points": [part["points"] for part in parts],
                "point_frame": [part["point_frame"] for part in parts],
                "iq_scale": [float(part["iq_scale"]) for part in parts],
            }
            config = self.request_of(plan[0]).config
            write_labelled(stage, config, self.labels, columns, arrays, signals, options.iq)
            if sizes := bytes_of_signals(stage, len(parts)):
                more["file_size"] = sizes
            found = circumstances(arrays["joints_m"], np.asarray(columns["label"]), **more)
            found["start_place"] = np.concatenate([found["start_place"], found["room"]], axis=1)
            reasons = unpaired_reasons([one.draw for one in plan], columns["label"], self.labels)
            write_leaks(stage, found, columns, self.labels, reasons)
            (stage / ACTIVITIES_FILE).write_text(self.activities_text, encoding="utf-8")
            shutil.copyfile(self.out / SET_FILE, stage / SET_FILE)

    def _part_arrays(self, name: str) -> Iterator[np.ndarray]:
        """Yields an array of each part, one at a time."""
        return (np.asarray(read_npz(self._part_file(number))[name]) for number in range(len(self.plan)))

    def _geometry(self, heights: list[float]) -> SetGeometry:
        """Geometry from which signals are synthesised on demand."""
        return SetGeometry(
            method=self.weaver.method_name,
            board=self.weaver.board_of(self.request_of(self.plan[0]), self.rooms[0])[0],
            rooms=[(room.scene.photo, room.views) for room in self.rooms],
            time_s=next(self._part_arrays("motion_time")),
            motions_m=self._part_arrays("motion"),
            sequences={
                "seed": np.array([self.request_of(one).seed for one in self.plan], np.int64),
                "height_m": np.array(heights),
                **{
                    name: np.array([float(each) for each in self._part_arrays(name)])
                    for name in ("girth", "moving_power_db")
                },
            },
        )

    def _part_file(self, number: int) -> Path:
        return self.out / PARTS / f"{number:06d}.npz"

    @cached_property
    def splits(self) -> dict[str, list[str]]:
        """Split of each sequence, in one column for each of SPLIT_KEYS."""
        plan = self.plan
        return split_columns(
            self.options.seed,
            subject=[one.draw.subject for one in plan],
            room=[one.draw.room for one in plan],
            place=[(one.draw.room, one.draw.place) for one in plan],
            sentence=[one.sentence for one in plan],
        )


def write_labelled(
    stage: Path,
    config: RadarConfig,
    labels: tuple[str, ...],
    columns: dict[str, Any],
    arrays: dict[str, list[Any]],
    signals: Iterable[np.ndarray] | SetGeometry,
    kind: str,
) -> None:
    """Writes the store of a set into a folder.

    Args:
        stage: The folder.
        config: Radar of all sequences.
        labels: Names of the labels by number.
        columns: One value per sequence, without "label_name".
        arrays: "joints_m", "points", "point_frame" and "iq_scale" of each sequence.
        signals: As in `activity_store.write_set`.
        kind: One of IQ_KINDS.
    """
    counts = [len(points) for points in arrays["points"]]
    whole = {
        "joints_m": np.stack(arrays["joints_m"]),
        "iq_scale": np.array(arrays["iq_scale"]),
        "points": np.concatenate(arrays["points"]).astype(np.float32),
        "point_frame": np.concatenate(arrays["point_frame"]).astype(np.int32),
        "point_sequence": np.repeat(np.arange(len(counts)), counts).astype(np.int32),
    }
    names = [labels[label] for label in columns["label"]]
    write_set(stage, config, labels, columns | {"label_name": names}, whole, signals, kind)


def write_leaks(
    stage: Path,
    found: dict[str, np.ndarray],
    columns: dict[str, Any],
    labels: Sequence[str],
    reasons: dict[str, str] | None = None,
) -> dict[str, Any]:
    """Writes leaks.json.

    Args:
        stage: The folder.
        found: Circumstances by name, (sequence, column).
        columns: "label" and "draw" of each sequence.
        labels: Names of the labels by number.
        reasons: Why a circumstance cannot be equal for all labels. Default: none.

    Returns:
        The report.
    """
    report = leak_report(found, np.asarray(columns["label"]), np.asarray(columns["draw"]), labels, reasons)
    (stage / LEAKS_FILE).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    return report


def _comparable(text: str) -> Any:
    """Content that determines a set; the command may differ in words such as --quiet when resumed."""
    found = parse_json(text, SET_FILE)
    return found | {"command": ""} if isinstance(found, dict) else found


def split_columns(seed: int, **groups: Sequence[Any]) -> dict[str, list[str]]:
    """Builds the columns split_subject, split_place, split_room and split_sentence.

    Args:
        seed: Seed of the splits.
        **groups: Group of each sequence, for each of SPLIT_KEYS.

    Returns:
        Split of each sequence, by column.
    """
    return {f"split_{key}": split_of(groups[key], key, seed) for key in SPLIT_KEYS}


def split_of(groups: Sequence[Any], key: str, seed: int) -> list[str]:
    """Splits sequences by groups: entire groups go to train, validation or test in about the shares of SHARES.

    Args:
        groups: Group of each sequence.
        key: Purpose of the split, which selects the random stream.
        seed: Seed of the splits.

    Returns:
        Split of each sequence; all "train" for fewer than three groups.
    """
    unique = sorted(set(groups))
    if len(unique) < len(SPLITS):
        return [SPLITS[0]] * len(groups)
    order = stream(seed, "activity set", "split", key).permutation(len(unique))
    held = [max(1, round(share * len(unique))) for share in SHARES[1:]]
    names = [SPLITS[1]] * held[0] + [SPLITS[2]] * held[1] + [SPLITS[0]] * len(unique)
    of = {unique[int(group)]: name for group, name in zip(order, names, strict=False)}
    return [of[group] for group in groups]
