"""How does a recogniser do on people, rooms, mounts and firmware that it was not trained on? All are generated.

    python -m studies run recognised_elsewhere iwr6843 --sequences FOLDER --people 16 --strangers 12

Stands in for recordings of a board of which none are at hand. Strangers are generated, too, by a recipe that differs in
all that a user does not know: a higher or lower board that looks down (one in four hangs 1.6 to 3 m high), a wall and
more furniture, more clutter, people farther away who sway more and keep another pace, a lower threshold and no second
peak. What motions, skin and noise are like is the same in both, so real recordings are harder than this. The same
strangers are scored under each condition of `other_boards`, which no recogniser knows of: other settings of the
firmware, things that move and are nobody, lost frames, columns that are named wrongly. `said` is what `recognise score`
has to say of the recordings without their labels.
"""

import argparse
import re
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from mmweaver.recognition.generated_sequences import SequenceRecipe, generate_sequences
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.recogniser import Recogniser
from mmweaver.recognition.scoring import score_recordings
from mmweaver.recognition.subject_simulation import PerformancePrior
from mmweaver.recognition.task_file import RecognitionTask, read_task
from mmweaver.recognition.train_recogniser import fitted
from mmweaver.recognition.training_windows import TrainingOptions, generated_windows
from studies.manifest import StudyRun, content_of
from studies.recognition.blind_recognition import TASKS, result_row
from studies.recognition.other_boards import CONDITIONS, empty_place

SEED = 78
EMPTY_S = 60.0  # of the empty place, where it is recorded
LOWER_THRESHOLD = 0.85  # of the CFAR in range, in counts
HABITS = PerformancePrior(
    tempo_of_person=0.25, amplitude_of_person=0.25, on_spot=0.9, on_way=(0.9, 1.1), usual_amplitude=1.0,
    sway_mps=(0.02, 0.15), calm_sway_mps=(0.01, 0.06), held_sway_mps=(0.01, 0.06), heading_deg=25.0,
    at_turns=(0.0, 0.0),
)  # fmt: skip


def strangers_recipe(task: RecognitionTask) -> SequenceRecipe:
    """Other people in other rooms in front of a board that stands elsewhere, with other settings of its firmware."""
    firmware = replace(task.firmware, second_peak=None)
    if firmware.range_cfar is not None:
        firmware = firmware.with_threshold(LOWER_THRESHOLD * firmware.range_cfar.threshold)
    own = SequenceRecipe.of(task, HABITS, SEED)
    variation = replace(
        own.variation, distance_m=(1.5, 3.5), near_m=(0.8, 1.6), far_m=(2.8, 4.2), radar_height_m=(0.9, 2.0),
        tilt_deg=(0.0, 18.0), clutter_db=(0.0, 10.0), wall_share=1.0, wall_m=(3.8, 7.0), most_panels=9,
        gain_db=(-10.0, 2.0), noise_db=(-4.0, 8.0), albedo_db=(-8.0, 2.0), threshold_db=(-2.0, 2.0),
    )  # fmt: skip
    return replace(own, task=replace(task, firmware=firmware), variation=variation)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("task", choices=sorted(path.stem for path in TASKS.glob("*.toml")))
    parser.add_argument("--sequences", type=Path, required=True, help="folder of generated sequences; made if missing")
    parser.add_argument("--people", type=int, default=TrainingOptions().sequences)
    parser.add_argument("--strangers", type=int, default=12, help="people of each activity that are the test set")
    parser.add_argument(
        "--conditions", default="", metavar="REGEX", help="how names of `other_boards.CONDITIONS` begin"
    )


def _trained(
    task: RecognitionTask, training: list[PointRecording], settings: TrainingOptions, background: list[PointRecording]
) -> Recogniser:
    model = fitted(generated_windows(training, task, settings, background), [], task, settings)
    radar = replace(Quantisation.of(task), knows_place=bool(background))
    return replace(model, points=replace(model.points, radar=radar))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    task = read_task(TASKS / f"{options.task}.toml")
    training = generate_sequences(SequenceRecipe.of(task), options.people, options.sequences / "training")
    settings = TrainingOptions(sequences=options.people)
    alone = _trained(task, training, settings, [])
    rows = []
    for condition in (one for one in CONDITIONS if re.match(options.conditions, one.name)):
        began = time.process_time()
        recipe = strangers_recipe(task) if condition.recipe is None else condition.recipe(strangers_recipe(task))
        folder = options.sequences / ("strangers" if condition.recipe is None else re.sub(r"\W+", "_", condition.name))
        strangers = generate_sequences(recipe, options.strangers, folder)
        tested = strangers if condition.points is None else condition.recorded(strangers, SEED)
        model = alone
        if condition.empty_place:
            nobody = empty_place(EMPTY_S, task.recordings.frame_rate_hz)
            model = _trained(task, training, settings, condition.recorded([nobody], SEED))
        scores: dict[str, Any] = score_recordings(model, tested) | {"self_training": None}
        data = {"name": condition.name, "sha256": content_of(folder)["sha256"], "each": options.strangers}
        row = result_row(scores, data, "alone", "generated", time.process_time() - began)
        said = "contradiction" if scores["contradictions"] else "warning" if scores["warning"] else "nothing"
        rows.append(row | {"task": options.task, "said": said, "contradictions": scores["contradictions"]})
        print(condition.name, scores["window"]["balanced_accuracy"], said, scores["window"]["confusion"], flush=True)
    run.write("recognised_elsewhere", options.task, config={"options": asdict(settings)}, rows=rows)
