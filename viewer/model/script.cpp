#include <weft/viewer/model/script.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <weft/core/error.hpp>

namespace weft::viewer {
namespace {

MouseDrag drag_named(const std::string& name) {
  if (name == "rotate") return MouseDrag::kRotate;
  if (name == "pan") return MouseDrag::kPan;
  if (name == "pull") return MouseDrag::kPull;
  if (name == "carry") return MouseDrag::kCarry;
  return MouseDrag::kNone;
}

std::size_t numbers_of(const std::string& word) {
  if (word == "drag") return 5;
  return word == "scroll" || word == "wait" || word == "wait_time" ? 1 : 0;
}

}  // namespace

Script::Line Script::parse(const std::string& line) {
  std::istringstream stream(line);
  Line parsed;
  stream >> parsed.word;
  const std::string& word = parsed.word;
  const bool has_text = word == "key" || word == "do" || word == "drag" || word == "screenshot";
  const std::size_t expected = numbers_of(word);
  if (!has_text && expected == 0 && word != "quit") {
    throw InvalidArgument("'" + word +
                          "', expected key, do, drag, scroll, wait, wait_time, screenshot or quit");
  }
  if (has_text && !(stream >> parsed.text)) {
    throw InvalidArgument("'" + word + "' without a word after it");
  }
  for (std::string number; stream >> number;) {
    char* end = nullptr;
    parsed.numbers.push_back(std::strtod(number.c_str(), &end));
    if (*end != '\0') throw InvalidArgument("'" + number + "', expected a number");
  }
  if (parsed.numbers.size() != expected) {
    throw InvalidArgument("'" + word + "' with " + std::to_string(parsed.numbers.size()) +
                          " numbers, expected " + std::to_string(expected));
  }
  if (word == "key" && find_key(parsed.text) == nullptr) {
    throw InvalidArgument("key '" + parsed.text + "', expected one of the help page");
  }
  if (word == "do" && find_action(parsed.text) == nullptr) {
    throw InvalidArgument("action '" + parsed.text + "' is unknown");
  }
  if (word == "drag" && drag_named(parsed.text) == MouseDrag::kNone) {
    throw InvalidArgument("drag '" + parsed.text + "', expected rotate, pan, pull or carry");
  }
  return parsed;
}

Script::Script(std::string_view text, const std::string& name) {
  std::istringstream stream{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    try {
      lines_.push_back(parse(line));
    } catch (const InvalidArgument& error) {
      throw InvalidArgument(name + ":" + std::to_string(number) + ": " + error.what());
    }
  }
}

void Script::advance(Session& session, double seconds, double aspect) {
  waited_ += seconds;
  while (next_ < lines_.size()) {
    // One picture at a time.
    if (session.view().wants_screenshot) return;
    if (!run(lines_[next_], session, aspect)) return;
    ++next_;
    waited_ = 0.0;
  }
}

bool Script::drag(const Line& line, Session& session, double aspect) {
  const std::vector<double>& n = line.numbers;
  const MouseDrag kind = drag_named(line.text);
  if (waited_ == 0.0) {
    session.begin_drag(kind, {n[0], n[1]}, aspect);
    waited_ = 1e-9;
    return false;
  }
  const double part = n[4] > 0.0 ? std::min(waited_ / n[4], 1.0) : 1.0;
  session.drag_to({n[0] + part * (n[2] - n[0]), n[1] + part * (n[3] - n[1])}, aspect);
  if (part < 1.0) return false;
  session.end_drag();
  return true;
}

bool Script::run(const Line& line, Session& session, double aspect) {
  if (line.word == "wait") return waited_ >= line.numbers[0];
  if (line.word == "wait_time") {
    const SnapshotPtr shown = session.source().shown();
    return shown && (shown->state.time >= line.numbers[0] || shown->blow_up);
  }
  if (line.word == "drag") return drag(line, session, aspect);
  if (line.word == "key") (void)session.press(line.text);
  if (line.word == "do") session.perform(find_action(line.text)->action);
  if (line.word == "scroll") session.scroll(line.numbers[0]);
  if (line.word == "quit") session.perform(Action::kQuit);
  if (line.word == "screenshot") {
    session.view().screenshot_path = line.text;
    session.view().wants_screenshot = true;
  }
  return true;
}

}  // namespace weft::viewer
