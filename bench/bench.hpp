#pragma once

#include <filesystem>

namespace weft::bench {

/// Each measures one thing and writes results/<name>.csv; num_rounds sets how long it takes.
struct Settings {
  std::filesystem::path folder;
  int num_rounds = 40;
};

/// Nanoseconds per spring and other element of every law, against the floor of the same run.
void bench_laws(const Settings& settings);
/// Elements per chunk against time.
void bench_grain(const Settings& settings);
/// What the main thread spends on forces in a frame with 8 ms of other work; writes traces too.
void bench_frame(const Settings& settings);
#ifdef WEFT_WITH_BULLET
/// A step of the classic scene with Bullet alone, and with laws.
void bench_bullet(const Settings& settings);
/// Bullet's links against the fast solver: time and error in the same run.
void bench_fast(const Settings& settings);
/// Where damped cloths come to rest at several time steps and efforts.
void bench_drape(const Settings& settings);
/// One cloth of 1 thousand to 1 million nodes: time and memory per node.
void bench_scaling(const Settings& settings);
/// Whole worlds on one and two threads, and what a step is made of.
void bench_threads(const Settings& settings);
/// The worst frame of a cloth that tears.
void bench_tear(const Settings& settings);
/// Random cloths, thrown and pulled: how many explode with the fast solver and with Bullet's links.
void bench_explosions(const Settings& settings);
/// How a swinging sheet moves at stiffnesses of 100 N/m to 10 MN/m, beside what is right.
void bench_motion(const Settings& settings);
/// Falls, impacts and loads beside explicit integration in short steps.
void bench_motion_scenes(const Settings& settings);
/// Forces that nothing balances, at rest.
void bench_motion_rest(const Settings& settings);
/// Make what is right (truth/): minutes, and best in double precision. They only make what is not there.
void bench_swing_truth(const Settings& settings);
void bench_scenes_truth(const Settings& settings);
/// A step of a character's cape at each level of detail.
void bench_detail(const Settings& settings);
/// Time and size of a snapshot, and a rollback of eight steps.
void bench_snapshot(const Settings& settings);
/// The step in which sheets of a Bullet program are adopted, beside those that follow.
void bench_setup(const Settings& settings);
void bench_self_contact(const Settings& settings);
/// The recorder's cost, the sizes of recordings and pages, and pictures in a second.
void bench_playback(const Settings& settings);
#endif

}  // namespace weft::bench
