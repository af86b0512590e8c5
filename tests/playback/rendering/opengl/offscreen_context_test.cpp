#include <weft/playback/rendering/opengl/offscreen_context.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/opengl/gl_functions.hpp>

namespace weft::scenes {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class EmptyContext final : public GlContext {
 public:
  void make_current() override {}
  [[nodiscard]] Function find_function(const char*) const override { return nullptr; }
  [[nodiscard]] std::string description() const override { return "an empty context"; }
};

TEST(OffscreenContext, NamesTheVersionThatIsNotAvailable) {
  EXPECT_THAT([] { (void)open_offscreen_context({.major = 9, .minor = 7}); },
              ThrowsMessage<Error>(AllOf(HasSubstr("off-screen OpenGL"), HasSubstr("9.7"))));
}

TEST(OffscreenContext, OffersAllFunctionsOfTheRenderer) {
  const auto context = open_offscreen_context();
  context->make_current();
  const GlFunctions gl = load_gl_functions(*context);
  EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(OffscreenContext, NamesTheFunctionThatIsMissing) {
  EXPECT_THAT(
      [] { (void)load_gl_functions(EmptyContext()); },
      ThrowsMessage<Error>(AllOf(HasSubstr("glActiveTexture"), HasSubstr("an empty context"))));
}

}  // namespace
}  // namespace weft::scenes
