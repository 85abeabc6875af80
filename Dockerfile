# The service alone: no torch, no compiler, no recorded data.
#
#     docker build -t placecell .
#     docker run -p 127.0.0.1:8000:8000 -v placecell-maps:/data placecell
FROM python:3.11-slim

WORKDIR /app
COPY . .
RUN pip install --no-cache-dir --constraint constraints.txt ./client '.[service]'
RUN useradd --system --uid 10001 placecell && mkdir /data && chown placecell /data

ENV PLACECELL_DATA_DIR=/data \
    PLACECELL_MODELS_DIR=/app/models \
    NUMBA_CACHE_DIR=/tmp/numba \
    PYTHONUNBUFFERED=1
USER placecell
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=3s --start-period=20s \
    CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8000/readyz', timeout=2)"]
CMD ["placecell", "serve", "--host", "0.0.0.0", "--allow-remote"]
