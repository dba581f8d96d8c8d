#include "core/run/simulation.hpp"

namespace scree::core {

std::shared_ptr<void> make_object(const scree_object& table, const Use& use, const std::string& what) {
  std::shared_ptr<void> object(table.create(), [destroy = table.destroy](void* self) {
    if (self != nullptr) destroy(self);
  });
  if (object == nullptr) throw std::bad_alloc();
  for (const Setting& setting : use.settings) set_object(table, object.get(), setting, what);
  char why[512] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  if (table.check != nullptr && table.check(object.get(), &refusal) != 0)
    throw SceneErrors({use.place.text() + ": error: " + what + ": " + why});
  return object;
}

void set_object(const scree_object& table, void* object, const Setting& setting, const std::string& what) {
  std::vector<const char*> texts;
  for (const std::string& text : setting.value.texts) texts.push_back(text.c_str());
  const scree_value value{
      sizeof(scree_value),   setting.value.type, setting.value.numbers.data(),        setting.value.rows,
      setting.value.columns, texts.data(),       static_cast<uint32_t>(texts.size()), 0};
  char why[512] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  if (table.set(object, setting.property, &value, &refusal) != 0)
    throw SceneErrors({setting.place.text() + ": error: " + what + ": '" + setting.name + "': " + why});
}

}  // namespace scree::core
