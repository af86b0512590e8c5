// Tested by tests/viewer/window_test.py.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cctype>

#include <weft/viewer/model/action.hpp>
#include <weft/viewer/ui/window.hpp>

namespace weft::viewer {
namespace {

struct Named {
  int key;
  const char* name;
};

constexpr std::array kNames = std::to_array<Named>({
    {GLFW_KEY_SPACE, "Space"},
    {GLFW_KEY_ENTER, "Enter"},
    {GLFW_KEY_KP_ENTER, "Enter"},
    {GLFW_KEY_TAB, "Tab"},
    {GLFW_KEY_RIGHT, "Right"},
    {GLFW_KEY_LEFT, "Left"},
    {GLFW_KEY_UP, "Up"},
    {GLFW_KEY_DOWN, "Down"},
    {GLFW_KEY_PAGE_UP, "PageUp"},
    {GLFW_KEY_PAGE_DOWN, "PageDown"},
    {GLFW_KEY_HOME, "Home"},
    {GLFW_KEY_END, "End"},
    {GLFW_KEY_KP_ADD, "="},
    {GLFW_KEY_KP_SUBTRACT, "-"},
    {GLFW_KEY_ESCAPE, "Escape"},
});

bool is_modifier(int key) {
  return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

/// The key without modifiers, as an American keyboard has it.
std::string plain_name(int key) {
  for (const Named& named : kNames) {
    if (named.key == key) return named.name;
  }
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25) {
    return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
  }
  // GLFW numbers keys with a sign by its ASCII code.
  if (key > GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT) {
    return std::string(1, static_cast<char>(key));
  }
  return {};
}

std::string with_modifiers(const std::string& name, int modifiers) {
  std::string text;
  if ((modifiers & GLFW_MOD_CONTROL) != 0) text += "Ctrl+";
  if ((modifiers & GLFW_MOD_SHIFT) != 0) text += "Shift+";
  return text + name;
}

}  // namespace

std::string key_name(int key, int scancode, int modifiers) {
  if (is_modifier(key)) return {};
  const bool has_sign = key > GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT;
  if (const char* sign = has_sign ? glfwGetKeyName(key, scancode) : nullptr) {
    std::string name(sign);
    if (name.size() == 1) {
      name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    }
    // Where + has a key of its own it means what the American = key does.
    if (name == "+") name = "=";
    if (find_key(with_modifiers(name, modifiers)) != nullptr) {
      return with_modifiers(name, modifiers);
    }
  }
  const std::string name = plain_name(key);
  if (name.empty()) return {};
  // The plus sign is Shift and = on an American keyboard.
  if (name == "=") modifiers &= ~GLFW_MOD_SHIFT;
  return with_modifiers(name, modifiers);
}

}  // namespace weft::viewer
