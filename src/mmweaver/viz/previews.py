"""The pictures of a folder of results, by file name."""

from mmweaver.viz.animation import draw_animation
from mmweaver.viz.preview import draw_preview

PREVIEWS = {"preview.png": draw_preview, "preview.gif": draw_animation}
