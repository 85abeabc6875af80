# The service alone: no torch, no compiler, no recorded data. deploy/README.md says how to run it.
#
#     docker build -t placecell:0.1.0 .
#
# Every package is checked against the hashes in requirements/. The base images are named by tag;
# deploy/pin-images.sh writes their digests here and into deploy/, where a registry can be asked.
FROM python:3.11-slim-bookworm AS builder
WORKDIR /build
COPY . .
# A checkout made under a strict umask would leave the models unreadable to the service's user.
RUN chmod -R a+rX models
# Should anything be built from source after all: pip 26.2 and later pins its tools by this alone.
ENV PIP_BUILD_CONSTRAINT=/build/constraints.txt \
    PIP_NO_CACHE_DIR=1
# What builds our two packages stays behind; they bring nothing along.
RUN python -m venv /opt/build && \
    /opt/build/bin/pip install --require-hashes --only-binary :all: --requirement requirements/build.txt && \
    /opt/build/bin/pip wheel --no-deps --no-build-isolation --no-index --wheel-dir /wheels ./client . && \
    python -m venv /opt/venv && \
    /opt/venv/bin/pip install --require-hashes --only-binary :all: --requirement requirements/service.txt && \
    /opt/venv/bin/pip install --no-deps --no-index /wheels/*.whl && \
    /opt/venv/bin/pip check

FROM python:3.11-slim-bookworm
RUN useradd --uid 10001 --user-group --no-log-init --no-create-home --home-dir /nonexistent placecell && \
    install --directory --owner=placecell --group=placecell --mode=0750 /data
COPY --from=builder /opt/venv /opt/venv
COPY --from=builder /build/models /opt/models

# It writes to /data and /tmp only, so the rest may be read-only: --read-only --tmpfs /tmp.
# It listens on every address of the container, and so will not start without PLACECELL_KEYS_FILE.
# Unless told not to, ONNX Runtime reports its use to its makers.
ENV PATH=/opt/venv/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    NUMBA_CACHE_DIR=/tmp/numba \
    ORT_DISABLE_TELEMETRY=1 \
    PLACECELL_HOST=0.0.0.0 \
    PLACECELL_PORT=8000 \
    PLACECELL_DATA_DIR=/data \
    PLACECELL_MODELS_DIR=/opt/models
# By number: Kubernetes' runAsNonRoot can't tell who a name is.
USER 10001:10001
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=5s --timeout=3s --start-period=60s \
    CMD ["python", "-c", "import http.client, os, sys; c = http.client.HTTPConnection('127.0.0.1', int(os.environ['PLACECELL_PORT']), timeout=2); c.request('GET', '/readyz'); sys.exit(c.getresponse().status != 200)"]
CMD ["placecell", "serve"]
