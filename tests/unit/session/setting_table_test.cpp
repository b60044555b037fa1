#include "session/setting_table.hpp"

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "unit/session/setting_values.hpp"

namespace oval4d::session {
namespace {

TEST(SettingTable, SaysWhatAnotherObjectAndResetSetBack) {
    std::map<std::string, ResetOccasion, std::less<>> setBack;
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) setBack.emplace(setting.name.text, setting.setBack);
    });
    std::size_t tried = 0;
    for (const SettingValue& setting : settingValues()) {
        const auto found = setBack.find(setting.name);
        if (found == setBack.end()) continue;
        ++tried;
        Session session = sessionWith(setting);
        const bool isOfField = slicing::fieldIn(session.current.object) != nullptr;
        line(session, "reset");
        EXPECT_EQ(setting.isIn(session.current), found->second != ResetOccasion::by_reset_or_another_object)
            << setting.name;
        if (setting.name == "spacing") continue;  // the spacing changes with the size of the object
        line(session, isOfField ? "formula x^2+y^2+z^2 < 2-w" : "polytope 16-cell");
        EXPECT_EQ(setting.isIn(session.current), found->second == ResetOccasion::never) << setting.name;
    }
    EXPECT_EQ(tried, setBack.size()) << "each setting has a value to try";
}

TEST(SettingTable, ASettingChangesNoOther) {
    // The other settings that a setting may change. The w of the focus point is that of the focus slice, and the slices
    // span the object.
    const std::map<std::string, std::set<std::string>, std::less<>> others{{"pace", {"spacing"}},
                                                                           {"follow", {"spacing"}},
                                                                           {"boost", {"spacing"}},
                                                                           {"slices", {"spacing"}},
                                                                           {"focus", {"point"}},
                                                                           {"offset", {"point"}},
                                                                           {"w", {"focus", "offset", "point"}}};
    for (const SettingValue& setting : settingValues()) {
        if (setting.name == "polytope") continue;
        SCOPED_TRACE(setting.name);
        const QueryParameters before = settingTexts(settingsOf(sessionBefore(setting).current));
        const QueryParameters after = settingTexts(settingsOf(sessionWith(setting).current));
        ASSERT_EQ(before.size(), after.size());
        std::set<std::string> changed;
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (before[i] != after[i]) changed.insert(before[i].first);
        }
        changed.erase(setting.name);
        const auto allowed = others.find(setting.name);
        for (const std::string& name : changed)
            EXPECT_TRUE(allowed != others.end() && allowed->second.contains(name)) << "also changes " << name;
    }
}

}  // namespace
}  // namespace oval4d::session
