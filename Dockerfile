# An image with fidservo installed: docker build -t fidservo . (docs/install.md)
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends git npm ca-certificates
WORKDIR /source
COPY . .
RUN ./run package

FROM debian:bookworm-slim
COPY --from=build /source/build/release/packages/*.deb /tmp/packages/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/packages/fidservo_*.deb \
    && rm -rf /tmp/packages /var/lib/apt/lists/*
ENTRYPOINT ["fidservo"]
CMD ["--help"]
