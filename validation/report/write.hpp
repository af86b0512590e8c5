#pragma once

#include <filesystem>

#include <weft/scenes/output/output_folder.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// The folder of a report, which is this program's while the object lives. @throws Error as
/// OutputFolder.
[[nodiscard]] output::OutputFolder report_folder(const std::filesystem::path& path);

/// Writes index.html, report.json, junit.xml, pictures/<...>.jpg and tables/<...>.csv into the folder. Each file is written under a temporary name and renamed, so a reader sees the old file
/// or the new one, never a part; the page comes last. Files of an earlier report that this one does
/// not have are left alone.
/// @throws Error naming the path and the reason.
void write_report(const Report& report, const output::OutputFolder& folder);
/// The same, with a folder that is made if needed.
void write_report(const Report& report, const std::filesystem::path& folder);

/// Writes index.html anew from the folder's report.json, with the page of this program: for a report
/// made elsewhere or by an older version. Nothing is computed and no other file changes.
/// @throws Error naming the file and what is wrong with it.
void render_report(const std::filesystem::path& folder);

}  // namespace weft::validation
