# An image with fidservo installed: docker build -t fidservo . (docs/install.md)
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends git npm ca-certificates
WORKDIR /source
COPY . .
RUN ./run package

FROM debian:bookworm-slim
COPY --from=build /source/build/release/packages/*.deb /packages/
RUN apt-get update && apt-get install -y --no-install-recommends /packages/fidservo_*.deb \
    && rm -rf /packages /var/lib/apt/lists/*
ENTRYPOINT ["fidservo"]
CMD ["--help"]
