"""What each part of the network, of its loss and of its training contributes, in rooms of the validation kind.

    python -m studies run ablation --data DATASET --runs RUNS --steps 300 --rooms 48 --most 16
    python -m studies run ablation --data OTHER --runs RUNS --called ablation_power --power FILE --most 8

Every variant (`ablation_variants`) is trained for the same short time, from the same seed, in the same rooms, and
continues where it was stopped; each writes a file of its own. Test splits are not used: this table is for choosing.

Scores are those of signals with random phases, as in `learned_scores`, and differences of expected power maps, which do
not depend on phases, of everything and of the person alone: ghosts lie 15 to 20 dB below the person and below most
rooms, and show only there. `physics_in_photographed_room` and `realization` are given for comparison. With `--called`
rows are measured anew in another data set, next to a *whole* of their own. With `--power` nothing is trained: weights
of recipe `paper_power` and those of `weaver` that are included are scored, also with photos and motions of others.
"""

import argparse
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cache, cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, plan_text, read_plan, read_rooms
from mmweaver.models.hypernetwork_rooms import load_hypernetwork
from mmweaver.models.power_network import PowerNetwork
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import load_weights, shipped_weights
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.propagation.radar_equation import points_of
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.training.hypernetwork_training import HypernetworkRecipe, initial_power_network, measure_codes
from mmweaver.training.network_examples import ExpectedMaps, NetworkBatch, RoomExamples
from mmweaver.training.network_loss import Targets
from mmweaver.training.network_training import VALIDATION_SEED, NetworkLearner, TrainingRecipe, batch_sampler
from mmweaver.training.trainer import Trainer
from mmweaver.training.validation_sheet import differences_db
from studies.manifest import StudyRun
from studies.network.ablated_network import AblatedNetwork
from studies.network.ablation_variants import HYPERNETWORK, VARIANTS, WHOLE, AblationVariant
from studies.network.learned_scores import OTHER, Case, Method, cases_of, interval, learned, simulated
from studies.network.room_cache import RoomCache, digest
from studies.result_rows import complete_rows, dataset_of
from studies.scores.scorecard import METRICS, Representations
from studies.study import Reads

COLUMNS = ("ra_ssim", "rd_ssim", "ra_difference_db", "rd_difference_db")
MEAN_COLUMNS = ("mean_ra_db", "mean_rd_db", "person_ra_db", "person_rd_db")
UNKNOWN = {
    "seconds": "see the manifest",
    "metrics.*.baseline": "each variant has a file of its own; rows of this study are compared with the whole network",
}
FRAMES = 6  # of a sequence, whose mean maps are compared
REFERENCES: dict[str, Method] = {
    "physics_in_photographed_room": simulated(lambda case: reconstruct(case.room.photo), skin=OTHER, micro_seed=1),
    "realization": simulated(lambda case: case.true_scene, skin=OTHER, micro_seed=1),
}


class SampledExamples(RoomExamples):
    """A room whose targets are the maps of one sampled signal, though its geometry would give the expected maps."""

    @cached_property
    def _expected(self) -> ExpectedMaps | None:
        return None


class _PartOfLoss(NetworkLearner):
    """A learner without some terms of the loss."""

    def __init__(self, *arguments: Any, excluded: tuple[str, ...]):
        super().__init__(*arguments)
        self.excluded = excluded

    def terms(self, batch: NetworkBatch) -> dict[str, torch.Tensor]:
        terms = super().terms(batch)
        return {name: term for name, term in terms.items() if not any(word in name for word in self.excluded)}


@dataclass(frozen=True)
class AblationMaterial:
    """Rooms to train in, rooms to choose the best weights by, and the cases that are evaluated."""

    train: tuple[StoredRoom, ...]
    unseen: tuple[StoredRoom, ...]
    generic: StoredRoom
    cases: tuple[Case, ...]

    @classmethod
    def of(cls, data: Path, rooms: int, most: int | None) -> "AblationMaterial":
        """From a data set: so many rooms to train in, at most so many to evaluate in."""
        stored, plan = read_rooms(data), read_plan(data)
        train = [room for room in stored if "train" in room.split]
        unseen = tuple(room for room in stored if "validation" in room.split)
        if not train or not unseen:
            raise InputError(f"{data} lacks rooms to train in or to validate in; make more with: mmweaver dataset")
        order = stream(0, "ablation rooms").permutation(len(train))[:rooms]
        cases = tuple(cases_of(stored, "validation", 1, plan, 0, most))
        return cls(tuple(train[int(index)] for index in order), unseen, train[0], cases)

    @cached_property
    def mean(self) -> tuple[list[RoomExamples], list[RoomExamples]]:
        return self._examples(RoomExamples)

    @cached_property
    def sampled(self) -> tuple[list[RoomExamples], list[RoomExamples]]:
        return self._examples(SampledExamples)

    def _examples(self, kind: type[RoomExamples]) -> tuple[list[RoomExamples], list[RoomExamples]]:
        return [kind(room, "train") for room in self.train], [kind(room, "validation") for room in self.unseen]


def trained(variant: AblationVariant, material: AblationMaterial, out: Path, recipe: TrainingRecipe) -> NetworkLearner:
    """The variant, trained; its weights are those best on validation by its own loss."""
    recipe = replace(recipe, **dict(variant.recipe))
    rooms, unseen = material.sampled if variant.is_sampled else material.mean
    torch.manual_seed(recipe.seed)
    network = network_of(variant)
    if isinstance(network, PowerNetwork):
        measure_codes(network, rooms)
    learner = _PartOfLoss(network, rooms[0].room.config, excluded=variant.terms_without)
    if recipe.steps > 0:
        trainer = Trainer(
            learner, recipe, out,
            batches=(
                batch_sampler(rooms, recipe, recipe.seed, recipe.mirror),
                batch_sampler(unseen, recipe, VALIDATION_SEED + recipe.seed),
            ),
        )  # fmt: skip
        trainer.run()
    learner.eval()
    return learner


def network_of(variant: AblationVariant) -> ScattererNetwork:
    """The variant's network before training."""
    if variant.power:
        return initial_power_network(HypernetworkRecipe())
    return AblatedNetwork(variant.without)


class _OneCode(nn.Module):
    """Writes the same field whatever code it is given."""

    def __init__(self, written: torch.Tensor):
        super().__init__()
        self.written = written

    def forward(self, code: torch.Tensor) -> torch.Tensor:
        return self.written.expand(*code.shape[:-1], -1)


def with_one_code(network: ScattererNetwork, generic: StoredRoom) -> ScattererNetwork:
    """The hypernetwork, which now writes the fields of one photo and of the first pose in that room for all."""
    assert isinstance(network, PowerNetwork)
    joints, velocity = (torch.from_numpy(one[0])[None] for one in (generic.joints_m, generic.joint_velocity_mps))
    with torch.inference_mode():
        code = network.encode_room(SceneTensors.stack([RoomExamples(generic, "train").scene]))
        of_person = network.write_person(code, joints, velocity)[0, 0]
    network.add_module("room_writer", _OneCode(code.written[0]))
    network.add_module("person_writer", _OneCode(of_person))
    return network


class OtherMotion(Case):
    """A case whose joints are those of the room's next sequence, while the ground truth is its own."""

    @property
    def joints(self) -> tuple[np.ndarray, np.ndarray]:
        other = (self.index + 1) % len(self.room.split)
        return self.room.joints_m[other], self.room.joint_velocity_mps[other]


def photo_of(case: Case, variant: AblationVariant, generic: StoredRoom) -> StoredRoom:
    """The room whose photo is the input of a variant."""
    return {"own": case.room, "generic": generic, "shuffled": case.other}[variant.photo]


def scores(learner: NetworkLearner, photo: Callable[[Case], StoredRoom], case: Case) -> dict[str, float]:
    """{column: value of one case}."""
    sampled = sampled_scores(learned(learner.network, photo), case)
    return sampled if case.room.geometry is None else {**sampled, **mean_scores(learner, photo(case), case)}


def sampled_scores(method: Method, case: Case) -> dict[str, float]:
    """Scores of a signal with random phases against the ground truth."""
    truth, prediction = Representations(case.truth), Representations(method(case))
    return {name: METRICS[name].score(prediction, truth) for name in COLUMNS}


def mean_scores(learner: NetworkLearner, photo: StoredRoom, case: Case) -> dict[str, float]:
    """Differences of expected power maps in dB, of everything and of the person alone with receiver noise."""
    one = RoomExamples(case.room, "validation")
    joints, velocity = (torch.from_numpy(values)[None] for values in case.joints)
    frames = np.unique(np.linspace(0, joints.shape[1] - 1, FRAMES).astype(int))
    whole, alone = one.maps(case.index, frames)
    assert alone is not None, "the room's geometry is stored"
    targets = Targets(
        maps=PowerMaps.stack([whole]), static=PowerMaps.stack([one.static]), person=PowerMaps.stack([alone])
    )
    batch = NetworkBatch(
        scene=SceneTensors.stack([RoomExamples(photo, "validation").scene]), joints_m=joints, velocity_mps=velocity,
        frames=torch.from_numpy(frames)[None], targets=targets,
    )  # fmt: skip
    with torch.inference_mode():
        both = differences_db(targets.maps, learner.predict(batch))
        moving = learner.moving(learner.network.encode_room(batch.scene), batch)
        own = learner.radar.maps(points_of(moving, learner.radar.response))
        person = differences_db(_noisy(PowerMaps.stack([alone]), learner), _noisy(own, learner))
    return {
        "mean_ra_db": both["range_azimuth"], "mean_rd_db": both["range_doppler"],
        "person_ra_db": person["range_azimuth"], "person_rd_db": person["range_doppler"],
    }  # fmt: skip


def _noisy(maps: PowerMaps, learner: NetworkLearner) -> PowerMaps:
    noise = learner.radar.noise_maps()
    return PowerMaps(**{name: part + level for (name, part), level in zip(vars(maps).items(), noise, strict=True)})


def row_of(name: str, each: list[dict[str, float]], rooms: list[str]) -> dict[str, Any]:
    """The row of a variant: means and intervals over rooms, and the value of each case for paired comparison."""
    metrics = {}
    for column in each[0]:
        mean, low, high = interval(np.array([one[column] for one in each]), rooms)
        unit = METRICS[column].unit if column in METRICS else "dB"
        own = [round(one[column], 4) for one in each]
        metrics[column] = {"value": mean, "interval_95": [low, high], "unit": unit, "each": own}
    return {"method": name, "split": "validation", "n": len(each), "rooms": rooms, "metrics": metrics}


def slug(name: str) -> str:
    """The name of a variant as a file name."""
    return name.replace(",", "").replace("'", "").replace(" ", "_")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True)
    parser.add_argument("--runs", type=Path, required=True, help="folder for the variants' checkpoints")
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--rooms", type=int, default=48, help="to train in")
    parser.add_argument("--most", type=int, default=16, help="rooms to be evaluated in")
    parser.add_argument("--only", nargs="*", help="rows (default: all; with --power those of its networks)")
    parser.add_argument("--power", type=Path, action=Reads, help="weights of recipe paper_power: train nothing")
    parser.add_argument("--called", metavar="NAME", default="ablation", help="folder of the results")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    trained_before = {} if options.power is None else {WHOLE: shipped_weights(), HYPERNETWORK: options.power}
    known = [name for name, variant in VARIANTS.items() if not trained_before or trained_as(variant) in trained_before]
    chosen = options.only or [*known, *REFERENCES]
    unknown = [name for name in chosen if name not in known and name not in REFERENCES]
    if unknown:
        raise InputError(f"unknown rows {', '.join(unknown)}; known: {', '.join([*known, *REFERENCES])}")
    torch.set_num_threads(1)
    recipe = TrainingRecipe(
        steps=options.steps, warm_up_steps=options.steps // 10, validate_every=max(options.steps // 3, 1)
    )
    material = AblationMaterial.of(options.data, options.rooms, options.most)
    about: dict[str, Any] = {"data_plan": read_plan(options.data)}
    if trained_before:
        about["weights"] = {name: digest(file) for name, file in trained_before.items()}
    else:
        about |= {"recipe": asdict(recipe), "train_rooms": len(material.train)}
    rooms = [f"{case.room.kind}_{case.room.layout}" for case in material.cases]
    for name in chosen:
        done = RoomCache(options.runs / "scores", {**about, "row": name, "plan": plan_text(options.data)})
        evaluate = _evaluator(name, material, options.runs, recipe, trained_before)
        each = [
            done.figures(f"{case.room.folder.name}_{case.index}", partial(evaluate, case)) for case in material.cases
        ]
        row = row_of(name, each, rooms)
        rows = complete_rows([row], dataset=dataset_of(options.data), seeds=[0], unknown=UNKNOWN)
        run.write(options.called, slug(name), config=about, rows=rows)
        figures = (f"{column} {metric['value']:.3f}" for column, metric in row["metrics"].items())
        print(f"{name:32}", *figures, flush=True)


def trained_as(variant: AblationVariant) -> str:
    """The variant whose training another shares."""
    return next(name for name, known in VARIANTS.items() if known == variant.trained_as)


def _evaluator(
    name: str, material: AblationMaterial, runs: Path, recipe: TrainingRecipe, trained_before: dict[str, Path]
) -> Callable[[Case], dict[str, float]]:
    """A function that scores one case; a variant is trained, or its weights are read, when the first case is scored."""
    if name in REFERENCES:
        return partial(sampled_scores, REFERENCES[name])
    variant = VARIANTS[name]

    @cache
    def learner() -> NetworkLearner:
        shared = trained_as(variant)
        if shared not in trained_before:
            return trained(variant, material, runs / slug(shared), recipe)
        file = trained_before[shared]
        network, _ = load_hypernetwork(file) if variant.power else load_weights(file)
        assert isinstance(network, ScattererNetwork), "weights of target power"
        return NetworkLearner(network, material.cases[0].room.config)

    @cache
    def final() -> NetworkLearner:
        found = learner()
        if variant.has_one_code:
            found.network = with_one_code(found.network, material.generic)
        return found

    def evaluate(case: Case) -> dict[str, float]:
        if variant.motion == "other":
            case = OtherMotion(case.room, case.index, case.other, case.seed_of_plan, case.lighting)
        return scores(final(), lambda one: photo_of(one, variant, material.generic), case)

    return evaluate
