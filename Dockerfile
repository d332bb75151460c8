# A hosted demo of the studio on a CPU: docs/studio.md, "Host a demo". Needs BuildKit, Docker's builder since 23.0.
FROM python:3.11-slim AS build
COPY . /tmp/mmweaver
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels /tmp/mmweaver

FROM python:3.11-slim
# PyTorch's index of CPU wheels; the default build would add gigabytes of CUDA
ARG TORCH_WHEELS
# headers are for compiling extensions
RUN pip install --no-cache-dir --index-url "${TORCH_WHEELS:?give --build-arg TORCH_WHEELS=<PyTorch's index of CPU wheels>}" "torch>=2.11,<2.14" \
    && rm -rf /usr/local/lib/python3.11/site-packages/torch/include
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels \
    pip install --no-cache-dir "$(ls /wheels/*.whl)[studio]" && useradd --create-home visitor
USER visitor
WORKDIR /home/visitor
EXPOSE 8765
CMD ["mmweaver", "studio", "--host", "0.0.0.0", "--no-browser"]
