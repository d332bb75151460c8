"""MotionGPT: text to motion by a language model whose vocabulary includes motion tokens. Start with `motiongpt.py`.

Requires the extra `pretrained` (transformers).
"""
