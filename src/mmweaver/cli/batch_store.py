"""mmweaver generate --texts --store: one labelled set in place of folders; each sentence is a label."""

import argparse
import json
import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.cli.batch import given_placing
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need

if TYPE_CHECKING:
    from mmweaver.generate import Weaver
    from mmweaver.generation import Room
    from mmweaver.request import Request

NOT_STORED = ("fps", "html")


def check_store(arguments: argparse.Namespace) -> None:
    """Raises InputError for options that a stored set does not have, and for `--iq` without one."""
    if not arguments.store:
        if arguments.iq is not None:
            raise InputError("--iq is for --store; result folders hold complex64")
        return
    need("dataset", "--store", "zarr")
    if arguments.texts is None:
        raise InputError(
            "--store is for --texts; a single sequence becomes a store with: mmweaver export DIR --to zarr --out OUT"
        )
    for name in NOT_STORED:
        if getattr(arguments, name) is not None:
            raise InputError(f"--store keeps cubes at the radar's frame rate; leave out --{name}, or --store")
    if arguments.bin or arguments.draws != "matched":
        name = "--bin" if arguments.bin else "--draws free"
        raise InputError(f"--store holds cubes of matched draws; leave out {name}, or --store")
    if arguments.points == "firmware":
        raise InputError("--store holds the points of our own detector; leave out --points firmware, or --store")


def run_store(
    arguments: argparse.Namespace, weaver: "Weaver", room: "Room", requests: "dict[str, Request]", out: Path
) -> int:
    """Makes what is missing of the set and says its verdict. Raises InputError."""
    import tomli_w

    from mmweaver.activity_sets.build_set import SetBuilder, SetOptions
    from mmweaver.activity_sets.confounders import verdict_of
    from mmweaver.activity_sets.paired_sampling import unplaceable
    from mmweaver.cli.activity_set import make_with_bar

    refused = unplaceable(requests, room.scene, arguments.seed)
    kept = [text for text in requests if text not in refused]
    if not kept:
        raise InputError(f"none of the sentences could be made; the first: {next(iter(refused.values()))}")
    frames = requests[kept[0]].frames
    options = SetOptions(each=arguments.repeat, seconds=frames * weaver.radar.frame_period_s, seed=arguments.seed)
    if arguments.iq is not None:
        options = replace(options, iq=arguments.iq)
    if arguments.board is not None:
        options = replace(options, board=str(arguments.board))
    command = shlex.join(["mmweaver", *sys.argv[1:]]) if sys.argv[1:2] == ["generate"] else "mmweaver generate"
    builder = SetBuilder(
        out, {text: (text,) for text in kept}, [room], weaver, options, command=command,
        activities_text=tomli_w.dumps({"activities": {text: [text] for text in kept}}), given=given_placing(arguments),
    )  # fmt: skip
    report = make_with_bar(builder, quiet=arguments.quiet)
    left_out = [{"text": text, "why": why} for text, why in refused.items()]
    if arguments.json:
        print(json.dumps({"out": str(out), "leaks": report, "refused": left_out}, ensure_ascii=False))
    elif not arguments.quiet:
        print(f"{len(kept)} sentences x {arguments.repeat} sequences in {out}; {verdict_of(report)}")
        for one in left_out:
            print(f"left out {one['text']!r}: {one['why']}")
    return 0
