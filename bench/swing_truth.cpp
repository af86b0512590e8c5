#include "bench/swing_truth.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::bench {
namespace {

constexpr int kSampleNodes = 5;  // along an edge
constexpr int kSampleSteps = 6;  // from one state to the next

std::string row(const std::string& kind, const SwingTruth& truth) {
  return fmt::format("{},{:.6g},{:.6g},{:.6g},{:.4g},{:.4g},{:.3g}\n", kind, truth.first_energy,
                     truth.later_energy, truth.turning_time, truth.largest_stretch,
                     truth.mean_stretch, truth.residual);
}

std::vector<double> numbers_of(const std::string& line, const std::filesystem::path& file) {
  std::vector<double> numbers;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) {
    try {
      numbers.push_back(std::stod(cell));
    } catch (const std::exception&) {
      throw Error(file.string() + ": '" + cell + "' is no number");
    }
  }
  return numbers;
}

}  // namespace

std::vector<SwingSheet> swing_sheets() {
  return {{"hang_50", 50, 1.0}, {"hang_25", 25, 0.25}};
}

std::vector<double> swing_stiffnesses() {
  return {1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
}

validation::Places sampled(const validation::Places& places, int nodes) {
  validation::Places sample;
  for (std::size_t step = 0; step < places.size(); step += kSampleSteps) {
    Matrix3X<double> state(3, kSampleNodes * kSampleNodes);
    for (int j = 0; j < kSampleNodes; ++j) {
      for (int i = 0; i < kSampleNodes; ++i) {
        const auto place = [&](int k) { return k * (nodes - 1) / (kSampleNodes - 1); };
        state.col(j * kSampleNodes + i) = places[step].col(place(j) * nodes + place(i));
      }
    }
    sample.push_back(std::move(state));
  }
  return sample;
}

std::string swing_key(const SwingSheet& sheet, double stiffness) {
  return fmt::format("{}_1e{:.0f}", sheet.name, std::log10(stiffness));
}

std::filesystem::path swing_truth_file(const std::filesystem::path& folder,
                                       const std::string& key) {
  return folder / ("swing_" + key + ".csv");
}

void write_swing_truths(const std::filesystem::path& folder, const std::string& key,
                        const SwingTruths& truths) {
  const std::filesystem::path path = swing_truth_file(folder, key);
  std::ofstream file(path);
  file << "kind,energy_0_1_J,energy_1_3_J,turning_time_s,largest_stretch,mean_stretch,residual\n"
       << row("converged", truths.converged);
  if (truths.exact) file << row("exact", *truths.exact);
  file
      << "# places [m] of 25 nodes of the run that is right, ten times a second: x, y, z of each\n";
  for (const Matrix3X<double>& state : truths.sample) {
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      file << fmt::format("{}{:.5f}", i == 0 ? "" : ",", state.data()[i]);
    }
    file << '\n';
  }
  file.close();
  if (!file) throw Error(path.string() + ": cannot be written");
}

SwingTruths read_swing_truths(const std::filesystem::path& folder, const std::string& key) {
  const std::filesystem::path path = swing_truth_file(folder, key);
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) {
    throw Error(path.string() + ": cannot be read; weft-bench swing_truth makes it");
  }
  SwingTruths truths;
  while (std::getline(file, line)) {
    if (line.starts_with('#')) continue;
    const bool is_converged = line.starts_with("converged,");
    if (!is_converged && !line.starts_with("exact,")) {
      const std::vector<double> numbers = numbers_of(line, path);
      if (numbers.size() != 3 * kSampleNodes * kSampleNodes) {
        throw Error(fmt::format("{}: a state of {} numbers, expected {}", path.string(),
                                numbers.size(), 3 * kSampleNodes * kSampleNodes));
      }
      truths.sample.emplace_back(
          Eigen::Map<const Matrix3X<double>>(numbers.data(), 3, kSampleNodes * kSampleNodes));
      continue;
    }
    const std::vector<double> n = numbers_of(line.substr(line.find(',') + 1), path);
    if (n.size() != 6) throw Error(path.string() + ": '" + line + "', expected six numbers");
    const SwingTruth truth{n[0], n[1], n[2], n[3], n[4], n[5]};
    if (is_converged) {
      truths.converged = truth;
    } else {
      truths.exact = truth;
    }
  }
  return truths;
}

}  // namespace weft::bench
