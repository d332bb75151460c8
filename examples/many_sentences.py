"""One room, read once; several sentences in it."""

from mmweaver import Weaver

weaver = Weaver()
room = weaver.sample_room()
for number, text in enumerate(("a person walks to the left", "someone waves with both hands", "a man squats twice")):
    result = weaver.generate(room, text, frames=25, seed=number)
    result.save(f"sequences/{number}")
    print(text, "->", len(result.points.frame), "points")
