"""Objects on furniture, on the floor and on walls; those on walls have their back at y = 0."""

from dataclasses import replace

import numpy as np

from mmweaver.scene.procedural.builder import Builder, Size, piece


@piece("tv")
def monitor(b: Builder):
    """A screen on a foot."""
    x = b.uniform(0.24, 0.31)
    b.box("black", 0.12, 0.09, 0.015)
    b.box("black", 0.025, (0.01, 0.04), (0.015, 0.20))
    b.box("black", x, (-0.02, 0.01), (0.11, 0.11 + 1.15 * x))
    b.box("monitor screen", x - 0.012, (-0.024, -0.02), (0.122, 0.098 + 1.15 * x))


@piece("laptop")
def laptop(b: Builder):
    """An open laptop."""
    b.box("aluminium", 0.17, 0.12, 0.018)
    b.box("aluminium", 0.17, (0.10, 0.115), (0.018, 0.24))
    b.box("laptop screen", 0.16, (0.097, 0.10), (0.03, 0.23))


@piece("keyboard")
def keyboard(b: Builder):
    """A keyboard."""
    b.box("keys", 0.21, 0.07, 0.02)


@piece("tv")
def television(b: Builder):
    """A television on its foot."""
    x = b.uniform(0.45, 0.62)
    b.box("television body", 0.25, 0.10, 0.02)
    b.box("television body", 0.04, 0.02, (0.02, 0.10))
    b.box("television body", x, 0.025, (0.06, 0.06 + 1.15 * x))
    b.box("television screen", x - 0.01, (-0.029, -0.025), (0.07, 0.05 + 1.15 * x))


@piece("tv", name="television", on_wall=True)
def wall_television(b: Builder):
    """A television mounted on the wall."""
    x = b.uniform(0.45, 0.62)
    high = 1.0 + 1.15 * x
    b.box("television body", x, (-0.06, 0.0), (1.0, high))
    b.box("television screen", x - 0.01, (-0.064, -0.06), (1.01, high - 0.01))


@piece("potted plant")
def plant(b: Builder):
    """A pot, a stem and clumps of leaves."""
    height = 1.1
    wide = 0.16 * (0.5 + 0.5 * height)
    b.box("clay", wide, wide, 0.28 * height, shape="cone")
    b.cylinder("stem", 0.015, (0.28 * height, 0.6 * height))
    for k in range(7):
        shade, leaf = b.uniform(0.7, 1.6), b.palette["leaf"]
        red, green, blue = leaf.colour
        turn, out = 2 * np.pi * k / 7 + b.uniform(-0.3, 0.3), 0.10 * height
        x, y, z = float(out * np.cos(turn)), float(out * np.sin(turn)), height * (0.48 + 0.08 * (k % 4))
        size = height * b.uniform(0.10, 0.15)
        leaf = replace(leaf, colour=(red * shade, green * shade, blue * shade))
        b.rounded(leaf, (x - size, x + size), (y - size, y + size), (z - 0.8 * size, z + 0.9 * size))


@piece("light")
def floor_lamp(b: Builder):
    """A foot, a rod and a luminous shade."""
    b.cylinder("metal", 0.13, 0.025)
    b.cylinder("metal", 0.012, (0.025, 1.45))
    b.box("large shade", 0.19, 0.19, (1.38, 1.64), shape="cone")


@piece("light")
def table_lamp(b: Builder):
    """A small lamp with a luminous shade."""
    b.cylinder("metal", 0.06, 0.02)
    b.cylinder("metal", 0.015, (0.02, 0.28))
    b.box("small shade", 0.11, 0.11, (0.22, 0.40), shape="cone")


@piece("cup")
def cup(b: Builder):
    """A mug."""
    _, green, blue = b.palette["china"].colour
    b.cylinder(replace(b.palette["china"], colour=(b.uniform(0.2, 0.7), green, blue)), 0.04, 0.10)


@piece("book")
def books(b: Builder):
    """A small pile of books."""
    b.box("red book", 0.12, 0.09, 0.025)
    b.box("white book", (-0.10, 0.11), 0.08, (0.025, 0.045))
    b.box("blue book", (-0.11, 0.10), (-0.085, 0.08), (0.045, 0.08))


@piece("bowl")
def bowl(b: Builder):
    """A bowl with fruit."""
    b.cylinder("bowl", 0.12, 0.06)
    b.rounded("fruit", (-0.09, 0.0), (-0.05, 0.04), (0.05, 0.14))
    b.rounded("fruit", (0.0, 0.09), (-0.03, 0.06), (0.05, 0.14))


@piece("microwave")
def microwave(b: Builder):
    """A microwave oven."""
    b.box("grey steel", 0.24, (-0.17, 0.18), 0.28)
    b.box("dark glass", (-0.22, 0.10), (-0.175, -0.17), (0.03, 0.25))


@piece()
def instrument(b: Builder):
    """A laboratory instrument: a grey box with a small screen."""
    wide, high = b.uniform(0.16, 0.24), b.uniform(0.16, 0.30)
    b.box("instrument", wide, (-0.16, 0.18), high)
    b.box("instrument screen", (-wide + 0.03, 0.02), (-0.165, -0.16), (0.05, high - 0.03))


@piece("cardboard")
def carton(b: Builder):
    """A cardboard box."""
    x, y, z = b.uniform(0.18, 0.28), b.uniform(0.15, 0.24), b.uniform(0.25, 0.42)
    b.box("cardboard", x, y, z)
    b.box("tape", 0.03, y, (z, z + 0.002))


@piece()
def bin(b: Builder):
    """A wastepaper bin."""
    b.box("dark", 0.13, 0.13, 0.32, shape="cone")


@piece("rug", is_free=True)
def rug(b: Builder):
    """A rug, flat enough to walk on."""
    b.box("accent", 0.9, 0.6, 0.012)


@piece("rug", is_free=True)
def mat(b: Builder):
    """An exercise mat."""
    b.box("foam", 0.32, 0.9, 0.015)


# On walls -----------------------------------------------------------------------------------------------------------
@piece(on_wall=True)
def picture(b: Builder):
    """A framed picture."""
    x, z = b.uniform(0.22, 0.45), b.uniform(0.18, 0.32)
    b.box("dark_wood", x, (-0.025, 0.0), (1.5 - z, 1.5 + z))
    b.box("print", x - 0.03, (-0.028, -0.025), (1.53 - z, 1.47 + z))


@piece(on_wall=True)
def whiteboard(b: Builder, width_m: Size = (1.2, 1.8)):
    """A whiteboard with scribbles."""
    x = b.size(width_m) / 2
    b.box("metal", x, (-0.03, 0.0), (0.95, 1.95))
    b.box("enamel", x - 0.03, (-0.034, -0.03), (0.98, 1.92))
    b.box("metal", x - 0.1, (-0.08, -0.03), (0.93, 0.96))


@piece("cabinet", on_wall=True)
def wall_cabinet(b: Builder, width_m: float):
    """A cabinet above a counter."""
    x, count = width_m / 2, max(2, round(width_m / 0.45))
    b.box("white", x, (-0.33, 0.0), (1.45, 2.05))
    for k in range(count):
        start = -x + k * width_m / count
        end = start + width_m / count
        b.box("white", (start + 0.006, end - 0.006), (-0.348, -0.33), (1.46, 2.04))
        b.box("metal", (end - 0.05, end - 0.036), (-0.365, -0.348), (1.48, 1.60))


@piece("mirror-stuff", on_wall=True)
def mirror(b: Builder):
    """A tall mirror: depth cameras measure nothing there."""
    b.box("metal", 0.5, (-0.02, 0.0), (0.4, 2.0))
    b.box("mirror", 0.48, (-0.024, -0.02), (0.42, 1.98))


@piece("door-stuff", landmark="door", on_wall=True)
def door(b: Builder):
    """A closed door: leaf, frame and handle."""
    x, high = b.uniform(0.8, 0.95) / 2, 2.03
    leaf = replace(b.palette["wood"], pattern="upright") if b.chance(0.6) else b.palette["white"]
    side = 1.0 if b.chance(0.5) else -1.0
    at = side * (x - 0.08)
    b.box(leaf, x, (-0.025, 0.0), high)
    b.box("white", (-x - 0.07, -x), (-0.04, 0.0), high + 0.07)
    b.box("white", (x, x + 0.07), (-0.04, 0.0), high + 0.07)
    b.box("white", x, (-0.04, 0.0), (high, high + 0.07))
    b.box(leaf, x - 0.14, (-0.032, -0.025), (1.15, 1.85))
    b.box(leaf, x - 0.14, (-0.032, -0.025), (0.2, 0.95))
    b.box("metal", (min(at, at - 0.12 * side), max(at, at - 0.12 * side)), (-0.075, -0.06), (1.03, 1.05))
    b.box("metal", (at - 0.012, at + 0.012), (-0.075, -0.025), (1.02, 1.06))


@piece("window-other", landmark="window", on_wall=True)
def window(b: Builder):
    """A bright pane in a frame with a sill, sometimes with curtains."""
    x, low, high = b.uniform(1.1, 1.7) / 2, 0.92, 2.12
    b.box("window pane", x, (-0.012, 0.0), (low, high))
    for a in (-x - 0.06, -0.03, x):
        b.box("window frame", (a, a + 0.06), (-0.05, 0.0), (low - 0.06, high + 0.06))
    for z in (low - 0.06, high):
        b.box("window frame", x, (-0.05, 0.0), (z, z + 0.06))
    b.box("window frame", x + 0.08, (-0.14, 0.0), (low - 0.09, low - 0.06))
    if b.chance(0.5):
        for a in (-x - 0.34, x + 0.04):
            for k in range(5):
                start = a + 0.06 * k
                b.box("cloth", (start, start + 0.06), (-0.20, -0.15), (0.05, 2.26), "curtain", "cylinder")
        b.box("metal", x + 0.36, (-0.19, -0.16), (2.26, 2.285), "curtain")
        for a in (-x - 0.36, x + 0.33):
            b.box("metal", (a, a + 0.03), (-0.19, 0.0), (2.26, 2.285), "curtain")


@piece("light", on_wall=True)
def ceiling_lamp(b: Builder):
    """A flat panel below the ceiling; its origin is on the ceiling."""
    b.box("light panel", 0.3, 0.3, (-0.04, 0.0))
