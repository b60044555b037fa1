// A clang-tidy plug-in that restricts all checks to the project's declarations. By default, checks also traverse system
// headers, where they report nothing but spend most of their time. clang-tidy 22 and later skips them itself.

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

// Matches the translation unit, before its declarations are traversed, and sets the scope of the traversal.
class SkipSystemHeaders : public clang::tidy::ClangTidyCheck {
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
        factories.registerCheck<SkipSystemHeaders>("oval4d-skip-system-headers");
    }
};

const clang::tidy::ClangTidyModuleRegistry::Add<Module> kModule("oval4d", "Leaves the system's headers out.");

}  // namespace
