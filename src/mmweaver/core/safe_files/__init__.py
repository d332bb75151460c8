"""The one place where files of others are opened. Every reader goes through it; a test holds it to that.

    regular_files    opens and reads regular files alone: no FIFO, device, socket or folder is waited for
    safe_text        text, JSON, TOML: bounded size and depth, every number finite
    safe_arrays      .npy and .npz: sizes are checked against the file before memory is taken, no pickles
    safe_pictures    PNG, JPEG, TIFF, WebP, BMP and PPM; no other decoder of Pillow can be reached
    safe_tensors     safetensors, and checkpoints of PyTorch without unpickling code
    safe_zarr        Zarr groups and arrays: metadata is checked against the chunk files
    bounded_codecs   chunks of Zarr that unpack to no more than their place

Whatever a library raises for a damaged file becomes an InputError of one line. Reference: docs/security.md.
"""
