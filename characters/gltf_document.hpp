#pragma once

// Tested by tests/characters/gltf_faults_test.cpp.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <weft/core/input_file.hpp>

namespace weft::characters {

/// A glTF 2.0 file taken apart: its JSON and the bytes of its buffers. Every fault is an
/// InvalidArgument "figure.glb: accessors[3]: ...". Private to the reader.
class GltfDocument {
 public:
  /// bytes: of a .glb or .gltf file; files: other files that it may name, none without it.
  GltfDocument(std::span<const std::byte> bytes, std::string name, const FileSource& files);

  [[nodiscard]] const nlohmann::json& root() const { return root_; }
  [[noreturn]] void fail(const std::string& message) const;

  /// Entries of a top-level array, which may be missing; an entry that is no object is a fault.
  [[nodiscard]] std::size_t count(const std::string& array) const;
  [[nodiscard]] const nlohmann::json& entry(const std::string& array, std::size_t index) const;

  /// A whole number that is an index into a top-level array; where: for messages. None if the key is
  /// missing.
  [[nodiscard]] std::optional<std::size_t> index(const nlohmann::json& object,
                                                 const std::string& key, const std::string& array,
                                                 const std::string& where) const;
  [[nodiscard]] std::size_t required_index(const nlohmann::json& object, const std::string& key,
                                           const std::string& array,
                                           const std::string& where) const;
  /// size numbers, finite; none if the key is missing.
  [[nodiscard]] std::optional<Eigen::VectorXd> numbers(const nlohmann::json& object,
                                                       const std::string& key, std::size_t size,
                                                       const std::string& where) const;
  /// Text of a key, or what else stands for it.
  [[nodiscard]] std::string text(const nlohmann::json& object, const std::string& key,
                                 const std::string& otherwise) const;

  /// Elements of an accessor as columns, normalised integers as numbers between -1 and 1. types:
  /// those that are allowed, such as "VEC3"; a fault for another one, for bytes outside the buffer and
  /// for numbers that are not finite.
  [[nodiscard]] Eigen::MatrixXd accessor(std::size_t index,
                                         const std::vector<std::string>& types) const;

  /// Says that so many numbers are about to be kept in memory; a fault if they are too many with all
  /// before them. Parts may share the same bytes of a file, so its size is no bound on them.
  void claim(std::size_t num_values, const std::string& where) const;

 private:
  void read_binary(std::span<const std::byte> bytes);
  void parse(std::span<const std::byte> text);
  void check_version() const;
  void read_buffers(const FileSource& files);
  [[nodiscard]] std::vector<std::byte> buffer_bytes(std::size_t index,
                                                    const FileSource& files) const;

  std::string name_;
  nlohmann::json root_;
  std::optional<std::vector<std::byte>> binary_;
  std::vector<std::vector<std::byte>> buffers_;
  mutable std::size_t num_claimed_ = 0;
};

}  // namespace weft::characters
