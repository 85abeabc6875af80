# The service, with PostgreSQL, S3 and traces: no torch, no compiler, no recorded data.
# docs/tutorials/deploy.md runs it.
#
#     docker build -t placecell:0.1.0 .
#
# Every package is checked against the hashes in requirements/. The base images are named by tag;
# deploy/pin-images.sh writes their digests here and into deploy/ if a registry can be reached.
FROM python:3.11-slim-bookworm AS builder
WORKDIR /build
COPY . .
# With a strict umask, the service's user could not read the models of the checkout.
RUN chmod -R a+rX models
# pip 26.2 and later pins the tools of a build from source by this variable only.
ENV PIP_BUILD_CONSTRAINT=/build/constraints.txt \
    PIP_NO_CACHE_DIR=1
# The build tools of the two packages stay in this stage. Wheels are built without dependencies.
RUN python -m venv /opt/build && \
    /opt/build/bin/pip install --require-hashes --only-binary :all: --requirement requirements/build.txt && \
    /opt/build/bin/pip wheel --no-deps --no-build-isolation --no-index --wheel-dir /wheels ./client . && \
    python -m venv /opt/venv && \
    /opt/venv/bin/pip install --require-hashes --only-binary :all: --requirement requirements/fleet.txt && \
    /opt/venv/bin/pip install --no-deps --no-index /wheels/*.whl && \
    /opt/venv/bin/pip check

FROM python:3.11-slim-bookworm
RUN useradd --uid 10001 --user-group --no-log-init --no-create-home --home-dir /nonexistent placecell && \
    install --directory --owner=placecell --group=placecell --mode=0750 /data
COPY --from=builder /opt/venv /opt/venv
COPY --from=builder /build/models /opt/models

# The service writes to /data and /tmp only, so the rest may be read-only: --read-only --tmpfs /tmp.
# It listens on every address of the container, so it does not start without PLACECELL_KEYS_FILE.
# ONNX Runtime sends usage data to its vendor unless this is set.
ENV PATH=/opt/venv/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    NUMBA_CACHE_DIR=/tmp/numba \
    ORT_DISABLE_TELEMETRY=1 \
    PLACECELL_HOST=0.0.0.0 \
    PLACECELL_PORT=8000 \
    PLACECELL_DATA_DIR=/data \
    PLACECELL_MODELS_DIR=/opt/models
# A number, because Kubernetes' runAsNonRoot cannot resolve a name.
USER 10001:10001
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=5s --timeout=3s --start-period=60s \
    CMD ["python", "-c", "import http.client, os, sys; c = http.client.HTTPConnection('127.0.0.1', int(os.environ['PLACECELL_PORT']), timeout=2); c.request('GET', '/readyz'); sys.exit(c.getresponse().status != 200)"]
CMD ["placecell", "serve"]
