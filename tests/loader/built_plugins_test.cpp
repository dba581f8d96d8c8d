// Every plug-in of this build passes the loader's own checks.
#include "core/plugin/catalogue.hpp"
#include "support/catch.hpp"

TEST_CASE("all built plug-ins open") {
  using scree::core::Catalogue;
  using scree::core::SearchPath;
  Catalogue catalogue(SearchPath{{}, {SearchPath::standard({}).others.back()}});
  REQUIRE(!catalogue.found().empty());
  for (const scree::core::Found& found : catalogue.found()) {
    INFO(found.file.string());
    const scree::core::Component& component = catalogue.open(found.kind, found.name);
    CHECK(component.name == found.name);
    CHECK(!component.version.empty());
  }
  CHECK(catalogue.opened().size() == catalogue.found().size());
  CHECK(catalogue.warnings().empty());
}
