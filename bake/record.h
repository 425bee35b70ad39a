// Values as bytes and back, bit for bit, on one machine: what a bake that was interrupted goes on from.
//
// A type is listed once, for both ways, by a function `fields(archive, value)` beside it, which hands its
// members to the archive. Numbers, enums, strings, vectors, optionals and maps need none.
#ifndef BRDFIT_BAKE_RECORD_H_
#define BRDFIT_BAKE_RECORD_H_

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace brdfit::bake {

// Bytes that are no record of what they are read as.
class BadRecord : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// Appends values.
class RecordWriter {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (put(values), ...);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

  static constexpr bool kReads = false;

 private:
  void put_bytes(const void* from, std::size_t count) {
    const std::size_t before = bytes_.size();
    bytes_.resize(before + count);
    if (count > 0) std::memcpy(bytes_.data() + before, from, count);
  }
  template <Plain T>
  void put(T& value) {
    put_bytes(&value, sizeof(T));
  }
  void put_size(std::size_t size) {
    std::uint64_t count = size;
    put(count);
  }
  void put(std::string& text) {
    put_size(text.size());
    put_bytes(text.data(), text.size());
  }
  template <class T>
  void put(std::vector<T>& values) {
    put_size(values.size());
    if constexpr (Plain<T>) {
      put_bytes(values.data(), values.size() * sizeof(T));
    } else {
      for (T& value : values) put(value);
    }
  }
  template <class T>
  void put(std::optional<T>& value) {
    bool is_there = value.has_value();
    put(is_there);
    if (is_there) put(*value);
  }
  template <class Key, class T>
  void put(std::map<Key, T>& values) {
    put_size(values.size());
    for (auto& [key, value] : values) {
      Key copy = key;
      put(copy);
      put(value);
    }
  }
  template <class T>
  requires(!Plain<T>) void put(T& value) { fields(*this, value); }

  std::vector<std::byte> bytes_;
};

// Reads them in the same order. Throws BadRecord where bytes are missing.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : rest_(bytes) {}
  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }
  // Throws BadRecord where bytes are left.
  void finish() const {
    if (!rest_.empty()) throw BadRecord("a record is too long");
  }

  static constexpr bool kReads = true;

 private:
  void get_bytes(void* to, std::size_t count) {
    if (rest_.size() < count) throw BadRecord("a record is too short");
    if (count > 0) std::memcpy(to, rest_.data(), count);
    rest_ = rest_.subspan(count);
  }
  template <Plain T>
  void get(T& value) {
    get_bytes(&value, sizeof(T));
  }
  // Everything takes a byte at least, so that a wrong size asks for no memory.
  std::size_t get_size(std::size_t bytes_each = 1) {
    std::uint64_t count = 0;
    get(count);
    if (count > rest_.size() / bytes_each) throw BadRecord("a record is too short");
    return static_cast<std::size_t>(count);
  }
  void get(std::string& text) {
    text.resize(get_size());
    get_bytes(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (Plain<T>) {
      values.resize(get_size(sizeof(T)));
      get_bytes(values.data(), values.size() * sizeof(T));
    } else {
      values = std::vector<T>(get_size());
      for (T& value : values) get(value);
    }
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool is_there = false;
    get(is_there);
    value.reset();
    if (!is_there) return;
    if constexpr (std::is_default_constructible_v<T>) {
      get(value.emplace());
    } else {
      read_into(*this, value);  // beside a type that cannot be made empty
    }
  }
  template <class Key, class T>
  void get(std::map<Key, T>& values) {
    values.clear();
    for (std::size_t left = get_size(); left > 0; --left) {
      Key key{};
      get(key);
      get(values[key]);
    }
  }
  template <class T>
  requires(!Plain<T>) void get(T& value) { fields(*this, value); }

  std::span<const std::byte> rest_;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_RECORD_H_
