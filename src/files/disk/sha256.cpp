// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/disk/sha256.h"

#include "core/demand.h"
#include "core/input_error.h"

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>
#include <openssl/sha.h>

namespace fidservo {

std::string sha256(std::string_view bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256_of_file(const std::filesystem::path& file) {
    constexpr std::size_t piece_bytes = 1U << 18U;
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    FIDSERVO_DEMAND(digest && EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) == 1);
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> piece(piece_bytes);
    while (stream) {
        stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        FIDSERVO_DEMAND(
            EVP_DigestUpdate(digest.get(), piece.data(), static_cast<std::size_t>(stream.gcount())) == 1);
    }
    if (!stream.eof()) throw InputError(fmt::format("{}: cannot be read", file.string()));
    std::array<unsigned char, SHA256_DIGEST_LENGTH> bytes{};
    FIDSERVO_DEMAND(EVP_DigestFinal_ex(digest.get(), bytes.data(), nullptr) == 1);
    return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace fidservo
