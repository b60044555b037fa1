// A module that clang-tidy loads: the other checks then walk through our declarations alone, not through those of the
// system's headers, about which they say nothing and in which they spend most of their time. From version 22 on
// clang-tidy does so by itself.

#include <vector>

#include <clang-tidy/ClangTidyCheck.h>
#include <clang-tidy/ClangTidyModule.h>
#include <clang-tidy/ClangTidyModuleRegistry.h>
#include <clang/AST/ASTContext.h>
#include <clang/ASTMatchers/ASTMatchFinder.h>
#include <clang/ASTMatchers/ASTMatchers.h>
#include <clang/Basic/SourceManager.h>

namespace {

using clang::ast_matchers::MatchFinder;

// Is asked about the translation unit before the walk goes into it.
class OursOnly : public clang::tidy::ClangTidyCheck {
  public:
    using ClangTidyCheck::ClangTidyCheck;

    void registerMatchers(MatchFinder* finder) override {
        finder->addMatcher(clang::ast_matchers::translationUnitDecl(), this);
    }

    void check(const MatchFinder::MatchResult& result) override {
        std::vector<clang::Decl*> ours;
        for (clang::Decl* declaration : result.Context->getTranslationUnitDecl()->decls())
            if (!result.SourceManager->isInSystemHeader(declaration->getLocation())) ours.push_back(declaration);
        result.Context->setTraversalScope(ours);
    }
};

class Module : public clang::tidy::ClangTidyModule {
    void addCheckFactories(clang::tidy::ClangTidyCheckFactories& factories) override {
        factories.registerCheck<OursOnly>("oval4d-ours-only");
    }
};

const clang::tidy::ClangTidyModuleRegistry::Add<Module> kModule("oval4d", "Leaves the system's headers out.");

}  // namespace
