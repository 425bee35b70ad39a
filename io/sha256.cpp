// SHA-256 of a file, by OpenSSL.
#include "io/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "io/input_file.h"

namespace brdfit::io {
namespace {

using DigestContext = std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)>;

void require(bool is_done) {
  if (!is_done) throw std::runtime_error("OpenSSL cannot compute SHA-256");
}

DigestContext begin_digest() {
  DigestContext context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  require(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  return context;
}

std::string end_digest(EVP_MD_CTX* context) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest = {};
  unsigned int length = 0;
  require(EVP_DigestFinal_ex(context, digest.data(), &length) == 1);
  std::string text;
  for (unsigned int k = 0; k < length; ++k) text += fmt::format("{:02x}", digest[k]);
  return text;
}

}  // namespace

std::string sha256_of_text(std::string_view text) {
  const DigestContext context = begin_digest();
  require(EVP_DigestUpdate(context.get(), text.data(), text.size()) == 1);
  return end_digest(context.get());
}

std::string sha256_of_file(const std::filesystem::path& file) {
  const InputFile input(file, "a file");
  const DigestContext context = begin_digest();
  constexpr std::size_t kChunkBytes = std::size_t{1} << 16;
  std::vector<std::byte> buffer(std::min(kChunkBytes, input.size()));
  for (std::size_t offset = 0; offset < input.size(); offset += buffer.size()) {
    const auto chunk = std::span(buffer).first(std::min(buffer.size(), input.size() - offset));
    input.read_at(offset, chunk);
    require(EVP_DigestUpdate(context.get(), chunk.data(), chunk.size()) == 1);
  }
  return end_digest(context.get());
}

}  // namespace brdfit::io
