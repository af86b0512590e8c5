#include <weft/scenes/recording/codec/topologies.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/codec/topology_codec.hpp>

namespace weft::scenes {
namespace {

/// Bodies of all layouts, each of which has a list of its own: 1,000 tears of 2,000 cloths.
constexpr std::size_t kMaxLayoutBodies = 2'000'000;

}  // namespace

void Topologies::check(const Row& row, const Header& header) const {
  const bool is_next = row.id == std::ssize(rows_);
  const bool is_cloth = row.body < header.bodies.size() && header.bodies[row.body].is_cloth;
  const bool is_later = row.first_frame >= layouts_.back().first_frame;
  // Nodes are only ever added.
  const bool grows = is_cloth && row.nodes > layouts_.back().codec.bodies()[row.body].num_nodes;
  if (!is_next || !is_cloth || !is_later || !grows || row.raw_bytes < 0 ||
      row.raw_bytes > kMaxChunkBytes) {
    throw Error(fmt::format("{}: table topology is not consistent: the file is damaged", file_));
  }
}

Topologies::Topologies(const Database& database, const Header& header, const FrameCodec& codec,
                       std::string file)
    : file_(std::move(file)), layouts_({{0, codec}}) {
  for (const RecordedBody& body : header.bodies) first_nodes_.push_back(body.num_nodes);
  const auto stored = header.meta.find("topology_hash");
  if (database.query_integer("PRAGMA user_version") != kTornFormatVersion) return;
  StreamHash hash;
  Statement rows = database.prepare(
      "SELECT id, first_frame, body, nodes, raw_bytes, hash FROM topology ORDER BY id");
  while (rows.step()) {
    const std::int64_t body = rows.integer(2);
    const std::int64_t nodes = rows.integer(3);
    const bool fits = body >= 0 && nodes >= 0 && nodes <= std::numeric_limits<int>::max();
    const Row row{rows.integer(0),
                  rows.integer(1),
                  fits ? static_cast<std::size_t>(body) : header.bodies.size(),
                  fits ? static_cast<int>(nodes) : 0,
                  rows.integer(4),
                  rows.text(5),
                  nullptr};
    check(row, header);
    if (row.first_frame != layouts_.back().first_frame) {
      layouts_.push_back({row.first_frame, layouts_.back().codec});
    }
    layouts_.back().codec.set_num_nodes(row.body, row.nodes);
    const auto frame_bytes = static_cast<std::int64_t>(layouts_.back().codec.frame_bytes());
    if (frame_bytes > kMaxFrameBytes || layouts_.size() > kMaxLayoutBodies / header.bodies.size()) {
      throw Error(fmt::format(
          "{}: table topology is larger than a run makes it: the file is damaged", file_));
    }
    for (const std::int64_t value : {row.id, row.first_frame, body, nodes, row.raw_bytes}) {
      hash.add(value);
    }
    hash.add(std::string_view(row.hash));
    rows_.push_back(row);
  }
  if (stored == header.meta.end() || stored->second != hash.hex()) {
    throw Error(
        fmt::format("{}: table topology does not have its hash: the file is damaged", file_));
  }
}

std::size_t Topologies::layout_at(std::int64_t frame) const {
  const auto after =
      std::upper_bound(layouts_.begin(), layouts_.end(), frame,
                       [](std::int64_t f, const Layout& layout) { return f < layout.first_frame; });
  return static_cast<std::size_t>(after - layouts_.begin()) - 1;
}

const FrameCodec& Topologies::codec_at(std::int64_t frame) const {
  return layouts_[layout_at(frame)].codec;
}

std::vector<std::byte> Topologies::read(const Database& database, const Row& row) const {
  try {
    Statement select = database.prepare("SELECT data FROM topology WHERE id = ?");
    select.bind(1, row.id);
    if (!select.step()) throw Error(file_ + ": no such topology");
    const std::vector<std::byte> data = select.blob(0);
    StreamHash hash;
    hash.add(data);
    if (hash.hex() != row.hash) throw Error(file_ + ": data does not have its hash");
    return decompress_chunk(data, static_cast<std::size_t>(row.raw_bytes), sizeof(std::uint32_t));
  } catch (const Error& error) {
    throw Error(
        fmt::format("{} (topology {}, from frame {} on)", error.what(), row.id, row.first_frame));
  }
}

void Topologies::set(const Database& database, std::int64_t frame, SceneState& state) const {
  std::vector<const Row*> last(first_nodes_.size(), nullptr);
  for (const Row& row : rows_) {
    if (row.first_frame <= frame) last[row.body] = &row;
  }
  for (std::size_t body = 0; body < state.cloths.size(); ++body) {
    const Row* const row = last[body];
    if (row == nullptr) continue;
    if (!row->decoded) {
      for (const Row& other : rows_) {
        if (other.body == body) other.decoded.reset();  // one of each cloth is enough to keep
      }
      try {
        row->decoded = std::make_shared<const ClothTopology>(
            decode_topology(read(database, *row), first_nodes_[body], row->nodes));
      } catch (const Error& error) {
        throw Error(fmt::format("{}: topology {}: {}", file_, row->id, error.what()));
      }
    }
    state.cloths[body].topology = row->decoded;
  }
}

bool Topologies::begins_at(std::int64_t frame) const {
  return std::any_of(rows_.begin(), rows_.end(),
                     [frame](const Row& row) { return row.first_frame == frame; });
}

void Topologies::add_to_hash(const Database& database, std::int64_t frame,
                             ContentHash& hash) const {
  for (const Row& row : rows_) {
    if (row.first_frame != frame) continue;
    hash.add_topology(static_cast<int>(row.body), read(database, row));
  }
}

}  // namespace weft::scenes
