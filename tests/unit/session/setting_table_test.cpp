#include "session/setting_table.hpp"

#include <map>

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
        if (setting.name == "spacing") continue;  // it is scaled with the object
        line(session, isOfField ? "formula x^2+y^2+z^2 < 2-w" : "polytope 16-cell");
        EXPECT_EQ(setting.isIn(session.current), found->second == ResetOccasion::never) << setting.name;
    }
    EXPECT_EQ(tried, setBack.size()) << "each setting has a value to try";
}

}  // namespace
}  // namespace oval4d::session
