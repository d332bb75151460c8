"""Safe opening of untrusted files. Every reader goes through this package, which a test enforces.

    regular_files    opens regular files only: never blocks on a FIFO, device, socket or folder
    safe_text        text, JSON, TOML: bounded size and depth, finite numbers
    safe_arrays      .npy and .npz: sizes are checked against the file before allocation, no pickles
    safe_pictures    PNG, JPEG, TIFF, WebP, BMP and PPM; no other Pillow decoder is reachable
    safe_tensors     safetensors, and PyTorch checkpoints without unpickling code
    safe_zarr        Zarr groups and arrays: metadata is checked against the chunk files
    bounded_codecs   Zarr chunks that decompress to exactly their size in the array

Any exception that a library raises for a damaged file becomes a one-line InputError. Reference: docs/security.md.
"""
