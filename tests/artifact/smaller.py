"""What of the README's recipes `make test` runs smaller than it stands there; by night test_sdist.py runs all of it."""

from tests.artifact.readme import Recipe

# Parts of recipes that take long, and what runs in their place.
SMALLER = {
    "--rooms living_room,office --layouts 1 --sequences 4": "--rooms office --layouts 1 --sequences 1 --frames 3",
    "--activities activities.toml --per-class 10": "--activities activities.toml --per-class 2 --seconds 1",
    "recognise train TASK.toml --sequences 8": "recognise train TASK.toml --sequences 2",
    "--out walk/ --seed 0": "--out walk/ --seed 0 --no-pictures --frames 5",
    "--out board/": "--out board/ --no-pictures",
    "--out left/": "--out left/ --no-pictures --frames 5",
    "--out empty/": "--out empty/ --no-pictures --no-analysis --range-bins 16,55",
    "overwrite=True)": "overwrite=True, pictures=False)",
}


def smaller(recipe: Recipe) -> Recipe:
    """A recipe with everything replaced that SMALLER names."""
    text = recipe.text
    for part, instead in SMALLER.items():
        text = text.replace(part, instead)
    return Recipe(text, recipe.is_python)
