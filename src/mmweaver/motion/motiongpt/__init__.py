"""MotionGPT: text to motion by a language model whose vocabulary includes motion tokens. Start at `motiongpt.py`.

Needs the extra `pretrained` (transformers).
"""
