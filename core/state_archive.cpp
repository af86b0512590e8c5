#include <weft/core/state_archive.hpp>

#include <cstring>

#include <weft/core/error.hpp>

namespace weft {

StateArchive StateArchive::reader(std::span<const std::byte> bytes) {
  StateArchive archive;
  archive.is_reading_ = true;
  archive.read_ = bytes;
  return archive;
}

void StateArchive::refuse(const std::string& what) const {
  throw Error("snapshot: part '" + part_ + "', byte " + std::to_string(position_) + ": " + what);
}

void StateArchive::raw(void* data, std::size_t size) {
  if (size == 0) return;
  if (!is_reading_) {
    const auto* const bytes = static_cast<const std::byte*>(data);
    written_.insert(written_.end(), bytes, bytes + size);
    return;
  }
  if (size > read_.size() - position_) {
    refuse("it ends after " + std::to_string(read_.size() - position_) + " more bytes, expected " +
           std::to_string(size));
  }
  std::memcpy(data, read_.data() + position_, size);
  position_ += size;
}

void StateArchive::check_count(std::int64_t rows, std::int64_t columns, std::size_t size) const {
  const auto left = static_cast<std::int64_t>((read_.size() - position_) / size);
  const bool fits = rows >= 0 && columns >= 0 && (columns == 0 || rows <= left / columns);
  if (!fits) {
    refuse(std::to_string(rows) + " x " + std::to_string(columns) +
           " numbers, expected no more than the " + std::to_string(left) + " that follow");
  }
}

void StateArchive::part(std::string_view name) {
  std::string stored(name);
  value(stored);
  if (stored != name) refuse("part '" + stored + "', expected '" + std::string(name) + "'");
  part_ = name;
}

void StateArchive::end() const {
  if (position_ == read_.size()) return;
  refuse(std::to_string(read_.size() - position_) + " bytes more than expected");
}

void StateArchive::value(bool& flag) {
  std::uint8_t byte = flag ? 1 : 0;
  value(byte);
  if (byte > 1) refuse("a flag is " + std::to_string(byte) + ", expected 0 or 1");
  flag = byte != 0;
}

void StateArchive::value(std::string& text) {
  auto size = static_cast<std::int64_t>(text.size());
  value(size);
  if (is_reading_) {
    check_count(size, 1, 1);
    text.resize(static_cast<std::size_t>(size));
  }
  raw(text.data(), text.size());
}

void StateArchive::value(std::vector<std::string>& texts) {
  list(texts, [&](std::string& text) { value(text); });
}

}  // namespace weft
