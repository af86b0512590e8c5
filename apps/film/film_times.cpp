#include "apps/film/film_times.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::app {
namespace {

/// The rate of a film in which nothing but the camera moves, or which has one frame. [1/s]
constexpr double kStillRate = 25.0;

/// More pictures than that are a mistake in a unit: an hour at 60 a second has 216,000.
constexpr double kMostPictures = 1e6;

/// Bullet's rounded steps must not make 59.9999 of 60 frames a second.
constexpr double kRateDigits = 1e3;

void check(const FilmRequest& request) {
  if (!request.frame_rate) return;
  if (*request.frame_rate > 0.0 && *request.frame_rate <= 1e3) return;
  throw InvalidArgument(
      fmt::format("--frame-rate = {} [1/s], expected > 0 and at most 1000", *request.frame_rate));
}

std::size_t count_of(double duration, double frame_rate) {
  const double count = duration * frame_rate;
  if (count > kMostPictures) {
    throw InvalidArgument(
        fmt::format("a film of {:.3g} s at {:.6g} [1/s] has {:.3g} pictures, "
                    "expected at most {:.0f}",
                    duration, frame_rate, count, kMostPictures));
  }
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(count)));
}

}  // namespace

FilmTimes frames_of_film(const scenes::RecordingReader& reader, const std::vector<int>& frames,
                         const FilmRequest& request) {
  check(request);
  const double begin = reader.frame_time(frames.front());
  const double length = reader.frame_time(frames.back()) - begin;
  const double intervals = static_cast<double>(frames.size()) - 1.0;
  double own_rate = kStillRate;
  if (length > 0.0) own_rate = std::round(kRateDigits * intervals / length) / kRateDigits;
  FilmTimes film;
  film.frame_rate = request.frame_rate.value_or(
      std::clamp(own_rate, 1.0 / kRateDigits, request.largest_default_rate));
  // The last frame is shown too, for as long as any other.
  const std::size_t count = count_of(length / request.speed, film.frame_rate) + (length > 0.0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = begin + request.speed * static_cast<double>(i) / film.frame_rate;
    const auto distance = [&](std::size_t k) {
      return std::abs(reader.frame_time(frames[k]) - time);
    };
    while (next + 1 < frames.size() && distance(next + 1) <= distance(next)) ++next;
    film.frames.push_back(frames[next]);
  }
  return film;
}

FilmTimes still_film(int frame, double duration, const FilmRequest& request) {
  check(request);
  if (!(duration > 0.0) || !std::isfinite(duration)) {
    throw InvalidArgument(fmt::format("--duration = {} [s], expected > 0", duration));
  }
  FilmTimes film;
  film.frame_rate = request.frame_rate.value_or(kStillRate);
  film.frames.assign(count_of(duration, film.frame_rate), frame);
  return film;
}

}  // namespace weft::app
