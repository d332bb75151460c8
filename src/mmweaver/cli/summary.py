"""The summary that a command prints at the end, for people or machines."""

from pathlib import Path
from typing import Any

from mmweaver.core.assumptions import UsualAssumption

MADE_BY = {"weaver": "weaver, the network", "physics": "physics"}


def machine_summary(out: str | Path, meta: dict[str, Any]) -> dict[str, Any]:
    """The summary as values for JSON: paths of the files, assumptions, seconds of each stage."""
    files = {name: str(Path(out) / name) for name in meta["files"]}
    method = {"method": meta["method"]} if "method" in meta else {}
    method |= {"warnings": meta["warnings"]} if "warnings" in meta else {}
    return {"out": str(out), "files": files, **method, "assumed": meta["assumed"], "seconds": meta["seconds"]}


def summary_lines(out: str | Path, meta: dict[str, Any], *, verbose: bool = False) -> list[str]:
    """One line each for the files, the radar, the people and the assumptions; usual ones only with `verbose`."""
    lines = [f"wrote {Path(out)} in {sum(meta['seconds'].values()):.1f} s"]
    paths = {name: str(Path(out) / name) for name in meta["files"]}
    width = max(map(len, paths.values()))
    lines += [f"  {paths[name]:<{width}}  {text}" for name, text in meta["files"].items()]
    lines += [f"method:  {MADE_BY.get(meta['method'], meta['method'])}"] if "method" in meta else []
    lines.append(_radar_line(meta))
    lines += [f"warning: {sentence}" for sentence in meta.get("warnings", [])]
    people = [meta["person"]] if "person" in meta else meta.get("people", [])
    lines += ["people:  nobody, the room is empty"] if meta.get("people") == [] else []
    for person in people:
        lines += [_person_line(person), *([f"motion:  {person['shown']}"] if person.get("shown") else [])]
    lines += [f"done:    {line}" for line in outcomes(meta)]
    shown = [one for one in meta["assumed"] if verbose or not isinstance(one, UsualAssumption)]
    lines += [f"assumed: {sentence}" for sentence in shown]
    if hidden := len(meta["assumed"]) - len(shown):
        what = f"{'more ' if shown else ''}standard assumption{'' if hidden == 1 else 's'}"
        lines.append(f"assumed: {hidden} {what} (--verbose prints {'it' if hidden == 1 else 'them'})")
    return lines


def _radar_line(meta: dict[str, Any]) -> str:
    fine = meta["resolution"]
    near_m, far_m = fine["range_window_m"]
    return (
        f"radar:   {meta['radar']['name']}, {meta['frames']} frames, {fine['range_m'] * 100:.2f} cm bins from"
        f" {near_m:.2f} to {far_m:.2f} m, {fine['radial_velocity_mps']:.3f} m/s bins to"
        f" {fine['max_velocity_mps']:.2f} m/s"
    )


def _person_line(person: dict[str, Any]) -> str:
    start, end = (f"({x:.2f}, {y:.2f})" for x, y in (person["starts_at_m"], person["ends_at_m"]))
    return (
        f"person:  {person['height_m']:.2f} m tall, from {start} to {end} m (right, ahead),"
        f" the pelvis moves {person['path_length_m']:.2f} m over the floor"
    )


def outcomes(meta: dict[str, Any]) -> list[str]:
    """One line per person on what was measured of every clause; none of recorded motions.

    Args:
        meta: Contents of meta.json.
    """
    lines = []
    for one in [meta] if "clauses" in meta else meta.get("people") or []:
        clauses = [clause if isinstance(clause, dict) else vars(clause) for clause in one["clauses"]]
        others = [clause for clause in clauses if clause["status"] != "done"]
        facts = [fact for clause in clauses for fact in clause.get("facts") or ()]
        done = f"{len(clauses) - len(others)} of {len(clauses)} clauses as measured on the joints"
        lines += [f"{done}{_measured(facts)}"] * bool(clauses)
        lines += [f"{clause['clause']!r} is {clause['status']}: {clause['how']}" for clause in others]
    return lines


def _measured(facts: list[dict[str, Any]]) -> str:
    """The facts of all steps in short: ' (1.9 m at 1.1 m/s; 3 times)'."""
    words = []
    for fact in facts:
        own = [f"{fact['path_m']:g} m at {fact['speed_mps']:g} m/s"] if "path_m" in fact else []
        own += [f"turned {fact['turn_deg']:g} degrees"] if "turn_deg" in fact and "path_m" not in fact else []
        words.append(", ".join([*own, f"{fact['duration_s']:g} s"]))
    return f" ({'; '.join(words)})" if words else ""
