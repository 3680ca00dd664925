# plan-cutters on a slim Debian, as a user who owns nothing but the work folder.
FROM python:3.12-slim-bookworm AS build
COPY . /source
RUN python -m venv /opt/plan-cutters && /opt/plan-cutters/bin/python -m pip install --no-cache-dir "/source[batch,pictures]"

FROM python:3.12-slim-bookworm
# The CAD kernel links libGL and libX11, although nothing is drawn; git is for `plan-cutters changed`.
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends libgl1 libx11-6 git && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/plan-cutters /opt/plan-cutters
RUN useradd --create-home --uid 1000 planner && mkdir /work && chown planner /work
ENV PATH="/opt/plan-cutters/bin:$PATH"
USER planner
WORKDIR /work
ENTRYPOINT ["plan-cutters"]
CMD ["--help"]
