#include <weft/viewer/model/action.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace weft::viewer {
namespace {

TEST(Actions, EveryActionHasOneRowWithAKeyAndAHelpOfItsOwn) {
  std::set<Action> actions;
  std::set<std::string_view> keys;
  std::set<std::string_view> ids;
  std::set<std::string_view> helps;
  for (const ActionInfo& info : action_table()) {
    EXPECT_TRUE(actions.insert(info.action).second) << info.id;
    EXPECT_TRUE(keys.insert(info.key).second) << info.key << " twice";
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    EXPECT_TRUE(helps.insert(info.help).second) << info.id;
    EXPECT_FALSE(info.help.empty()) << info.id;
    EXPECT_EQ(find_key(info.key), &info);
    EXPECT_EQ(find_action(info.id), &info);
  }
  // kQuit is the last one.
  EXPECT_EQ(actions.size(), static_cast<std::size_t>(Action::kQuit) + 1);
}

TEST(Actions, GroupsAreTogether) {
  std::set<std::string_view> seen;
  std::string_view last;
  for (const ActionInfo& info : action_table()) {
    if (info.group == last) continue;
    EXPECT_TRUE(seen.insert(info.group).second) << info.group << " is torn apart";
    last = info.group;
  }
}

TEST(Actions, AKeyWithoutARowIsNone) {
  EXPECT_EQ(find_key("Ctrl+Alt+Delete"), nullptr);
  EXPECT_EQ(find_action("fly"), nullptr);
}

TEST(Actions, ATooltipNamesTheKey) {
  EXPECT_THAT(tooltip(Action::kWindXLess),
              testing::AllOf(testing::HasSubstr("Wind along x"), testing::HasSubstr("[Shift+X]")));
}

}  // namespace
}  // namespace weft::viewer
