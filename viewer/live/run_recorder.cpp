#include <weft/viewer/live/run_recorder.hpp>

#include <weft/core/error.hpp>

namespace weft::viewer {

RunRecorder::RunRecorder(const std::string& path, const scenes::Scene& scene,
                         const scenes::Provenance& provenance, scenes::StoredPrecision precision)
    : output_(path, false),
      writer_(std::make_unique<scenes::RecordingWriter>(output_.partial(), scene, provenance,
                                                        precision)) {}

RunRecorder::~RunRecorder() {
  if (!writer_) return;
  try {
    writer_->commit();
  } catch (const Error&) {
    // Chunks that were committed before are there.
  }
}

void RunRecorder::add_frame(const scenes::SceneState& state) {
  writer_->add_frame(state);
}

void RunRecorder::set_blow_up(const scenes::BlowUp& blow_up) {
  writer_->set_blow_up(blow_up);
}

void RunRecorder::finish() {
  (void)writer_->finish();
  writer_.reset();
  output_.publish();
}

}  // namespace weft::viewer
