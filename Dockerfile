# A hosted demo of the studio on a CPU: docs/studio.md, "Host a demo".
FROM python:3.11-slim
# PyTorch's index of CPU wheels; the default build would add gigabytes of CUDA
ARG TORCH_WHEELS
RUN pip install --no-cache-dir --index-url "${TORCH_WHEELS:?give --build-arg TORCH_WHEELS=<PyTorch's index of CPU wheels>}" "torch>=2.11,<2.14"
COPY . /tmp/mmweaver
RUN pip install --no-cache-dir "/tmp/mmweaver[studio]" && rm -rf /tmp/mmweaver && useradd --create-home visitor
USER visitor
WORKDIR /home/visitor
EXPOSE 8765
CMD ["mmweaver", "studio", "--host", "0.0.0.0", "--no-browser"]
