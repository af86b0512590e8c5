#pragma once

#include <filesystem>
#include <functional>

#include <weft/scenes/output/output_folder.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// The folder for a VTP series; belongs to Weft once it is filled.
[[nodiscard]] output::OutputFolder vtp_folder(const std::filesystem::path& path);

/// Writes BODY_00000.vtp ... for every body but planes and series.pvd, which gives every file its time, last. Fields of the points:
/// velocity_m_s; of a cloth also mass_kg (NaN once it has torn, because a recording does not hold how a torn node's mass is shared out), pinned and
/// strain (node_strain()). Numbers have the recording's precision. Gives the number of VTP files.
int export_vtp_series(const RecordingReader& reader, const output::OutputFolder& folder,
                      const std::function<void(double part)>& on_progress = {});

}  // namespace weft::scenes
