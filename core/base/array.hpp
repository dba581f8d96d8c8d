#pragma once
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace scree::core {

/// Plain elements on a 64-byte boundary. Grows without the doubling of std::vector, so that memory per ball is what the
/// columns need. New elements are zero.
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array() = default;
  explicit Array(std::size_t n) { resize(n); }
  Array(const Array& other) { *this = other; }
  Array(Array&& other) noexcept { swap(other); }
  ~Array() { std::free(data_); }
  Array& operator=(const Array& other) {
    if (this != &other) {
      resize_for_overwrite(other.size_);
      if (size_ > 0) std::memcpy(static_cast<void*>(data_), other.data_, size_ * sizeof(T));
    }
    return *this;
  }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  void resize(std::size_t n) {
    const std::size_t old = size_;
    reserve(n);
    size_ = n;
    if (n > old) std::memset(static_cast<void*>(data_ + old), 0, (n - old) * sizeof(T));
  }
  /// Elements are left as they are found.
  void resize_for_overwrite(std::size_t n) {
    if (n > capacity_) {
      std::free(data_);
      data_ = nullptr;
      size_ = capacity_ = 0;
      reserve(n);
    }
    size_ = n;
  }
  void reserve(std::size_t n) {
    if (n <= capacity_) return;
    const std::size_t bytes = (n * sizeof(T) + 63) / 64 * 64;
    void* fresh = std::aligned_alloc(64, bytes);
    if (fresh == nullptr) throw std::bad_alloc();
    if (size_ > 0) std::memcpy(fresh, data_, size_ * sizeof(T));
    std::free(data_);
    data_ = static_cast<T*>(fresh);
    capacity_ = n;
  }
  /// Gives back what is held beyond the elements.
  void trim() {
    if (capacity_ == size_) return;
    Array exact(*this);
    swap(exact);
  }
  void push_back(const T& value) {
    const T copy = value;
    if (size_ == capacity_) reserve(size_ + size_ / 2 + 16);
    data_[size_++] = copy;
  }
  /// Gives the memory back.
  void release() { Array().swap(*this); }
  void fill(const T& value) {
    for (std::size_t k = 0; k < size_; ++k) data_[k] = value;
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t k) { return data_[k]; }
  const T& operator[](std::size_t k) const { return data_[k]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace scree::core
